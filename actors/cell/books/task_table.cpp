#include "actors/cell/books/task_table.hpp"

#include "actors/house/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

ROSCELL_CODEC(task_record)

task_entry* task_table::find(const std::string& task) {
  auto i = entries_.find(task);
  return i == entries_.end() ? nullptr : &i->second;
}

const task_entry* task_table::find(const std::string& task) const {
  auto i = entries_.find(task);
  return i == entries_.end() ? nullptr : &i->second;
}

task_entry* task_table::find_owned_by(const caf::actor_addr& owner) {
  for (auto& [task, entry] : entries_)
    if (entry.owner && entry.owner == owner)
      return &entry;
  return nullptr;
}

task_entry& task_table::add(task_record record) {
  auto& entry = entries_[record.task];
  entry.record = std::move(record);
  return entry;
}

void task_table::erase(const std::string& task) {
  entries_.erase(task);
}

void task_table::remember_ended(const task_terminated& reply) {
  ended_.erase(
      std::remove_if(ended_.begin(), ended_.end(),
                     [&](const auto& x) { return x.task == reply.task; }),
      ended_.end());
  ended_.push_back(reply);
  if (ended_.size() > limits::task::ended)
    ended_.pop_front();
}

const task_terminated* task_table::find_ended(const std::string& task) const {
  for (const auto& x : ended_)
    if (x.task == task)
      return &x;
  return nullptr;
}

const instance_spec* task_table::find_spec(const std::string& instance,
                                           const std::string& node) const {
  for (const auto& [task, entry] : entries_) {
    const auto& record = entry.record;
    if (record.state == task_state::terminating)
      continue;
    for (size_t i = 0; i < record.specs.size(); ++i)
      if (record.specs[i].instance == instance && record.nodes[i] == node)
        return &record.specs[i];
  }
  return nullptr;
}

std::vector<instance_spec>
task_table::wanted_on(const std::string& node) const {
  std::vector<instance_spec> result;
  for (const auto& [task, entry] : entries_) {
    const auto& record = entry.record;
    if (record.state != task_state::running)
      continue;
    for (size_t i = 0; i < record.specs.size(); ++i)
      if (record.nodes[i] == node)
        result.push_back(record.specs[i]);
  }
  return result;
}

std::vector<instance_spec> task_table::bound_to(const std::string& node) const {
  std::vector<instance_spec> result;
  for (const auto& [task, entry] : entries_)
    for (size_t i = 0; i < entry.record.specs.size(); ++i)
      if (entry.record.nodes[i] == node)
        result.push_back(entry.record.specs[i]);
  return result;
}

std::vector<std::string>
task_table::tasks_bound_to(const std::string& node) const {
  std::vector<std::string> result;
  for (const auto& spec : bound_to(node))
    if (result.empty() || result.back() != spec.task)
      result.push_back(spec.task);
  return result;
}

bool task_table::is_deploying_on(const std::string& node) const {
  return std::any_of(entries_.begin(), entries_.end(), [&](const auto& x) {
    const auto& record = x.second.record;
    return record.state == task_state::deploying
           && std::count(record.nodes.begin(), record.nodes.end(), node) > 0;
  });
}

} // namespace roscell
