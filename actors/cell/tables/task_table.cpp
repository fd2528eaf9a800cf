#include "actors/cell/tables/task_table.hpp"

#include "actors/cell/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

std::string set_of(const std::string& request) {
  // Few are of one, and a request may be long.
  if (request.find("\"set\":") == std::string::npos)
    return {};
  const auto body = json::parse(request, nullptr, false);
  if (!body.is_object())
    return {};
  const auto found = body.find("set");
  return found != body.end() && found->is_string() ? found->get<std::string>()
                                                   : std::string{};
}

const task_entry* task_table::find(const std::string& task) const {
  const auto i = entries_.find(task);
  return i == entries_.end() ? nullptr : &i->second;
}

claim_status task_table::claim_status_of(const std::string& task,
                                         const std::string& request,
                                         const std::string& id,
                                         bool replace) const {
  const auto* entry = find(task);
  if (!entry)
    return claim_status::unknown;
  if (entry->request != request)
    return replace && !entry->ending && is_settled(entry->state)
               ? claim_status::next_run
               : claim_status::other_body;
  if (entry->ending)
    return claim_status::ending;
  if (entry->state == task_state::deploying)
    return claim_status::deploying;
  return is_settled(entry->state) && !id.empty() && !is_of_run(task, id)
             ? claim_status::next_run
             : claim_status::accepted;
}

bool task_table::is_of_run(const std::string& task,
                           const std::string& id) const {
  const auto* entry = find(task);
  return entry
         && std::count(entry->request_ids.begin(), entry->request_ids.end(), id)
                > 0;
}

bool task_table::is_full() const {
  return entries_.size() >= limits::task::most;
}

void task_table::begin(const std::string& task, const std::string& request,
                       const std::string& id, int64_t now_unix_ms) {
  task_entry fresh;
  fresh.request = request;
  fresh.set = set_of(request);
  fresh.submitted_unix_ms = now_unix_ms;
  if (!id.empty())
    fresh.request_ids.push_back(id);
  if (const auto* former = find(task)) {
    fresh.run = former->run + 1;
    fresh.revisions = former->revisions;
    if (former->request != request)
      revise(fresh.revisions, former->request, {}, now_unix_ms);
  }
  entries_[task] = std::move(fresh);
}

void task_table::take_back(const task_record& former) {
  entries_.erase(former.task);
  apply(former);
}

bool task_table::begin_ending(const std::string& task) {
  const auto i = entries_.find(task);
  return i != entries_.end() && !std::exchange(i->second.ending, true);
}

void task_table::apply(const task_record& record) {
  auto& entry = entries_[record.task];
  entry.request = record.request;
  entry.set = set_of(record.request);
  entry.accepted = record.accepted;
  entry.state = record.state;
  entry.submitted_unix_ms = record.submitted_unix_ms;
  entry.ended_unix_ms = record.ended_unix_ms;
  entry.run = record.run;
  entry.request_ids = record.request_ids;
  entry.orders = record.orders;
  entry.deadline_unix_ms = record.deadline_unix_ms;
  entry.revisions = record.revisions;
  entry.update = record.update;
}

void task_table::forget(const std::string& task) {
  entries_.erase(task);
}

bool task_table::is_deploying(const std::string& task) const {
  const auto* entry = find(task);
  return entry && !entry->ending && entry->state == task_state::deploying;
}

bool task_table::is_running(const std::string& task) const {
  const auto* entry = find(task);
  return entry && !entry->ending && entry->state == task_state::running;
}

bool task_table::is_kept(const std::string& task) const {
  const auto* entry = find(task);
  return entry && !entry->ending;
}

std::vector<std::string> task_table::superfluous() const {
  std::vector<std::pair<int64_t, std::string>> settled;
  for (const auto& [task, entry] : entries_)
    if (is_settled(entry.state) && !entry.ending && entry.set.empty())
      settled.emplace_back(entry.submitted_unix_ms, task);
  std::sort(settled.begin(), settled.end());
  std::vector<std::string> result;
  for (size_t i = 0; i + limits::task::settled < settled.size(); ++i)
    result.push_back(settled[i].second);
  return result;
}

void task_table::remember_terminated(const task_terminated& reply) {
  terminated_.erase(
      std::remove_if(terminated_.begin(), terminated_.end(),
                     [&](const auto& x) { return x.task == reply.task; }),
      terminated_.end());
  terminated_.push_back(reply);
  if (terminated_.size() > limits::task::terminated)
    terminated_.pop_front();
}

const task_terminated*
task_table::find_terminated(const std::string& task) const {
  for (const auto& x : terminated_)
    if (x.task == task)
      return &x;
  return nullptr;
}

} // namespace roscell
