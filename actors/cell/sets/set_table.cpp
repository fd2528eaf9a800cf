#include "actors/cell/sets/set_table.hpp"

#include "actors/cell/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

ROSCELL_CODEC(task_set_record)

std::string run_id(const task_set_record& record, const std::string& task) {
  return "set." + task + "." + std::to_string(record.run);
}

const set_table::entry* set_table::find(const std::string& set) const {
  const auto found = sets_.find(set);
  return found == sets_.end() ? nullptr : &found->second.what;
}

std::vector<std::string> set_table::names() const {
  std::vector<std::string> result;
  for (const auto& [name, x] : sets_)
    result.push_back(name);
  return result;
}

bool set_table::is_full() const {
  return sets_.size() >= limits::task::sets;
}

bool set_table::apply(const task_set_record& record) {
  const auto body = json::parse(record.request, nullptr, false);
  if (!body.is_object())
    return false;
  auto& x = sets_[record.task];
  // Another request may do where the former one has failed.
  if (x.what.record.revision != record.revision)
    for (auto& [node, work] : x.nodes) {
      work.problem.clear();
      work.retry = time_point::min();
      work.pause.reset();
    }
  const bool is_same = x.what.record.request == record.request && x.what.tasks;
  x.what = {record, body.get<task_set_request>(),
            is_same ? x.what.tasks : std::make_shared<node_tasks>()};
  return true;
}

void set_table::forget(const std::string& set) {
  sets_.erase(set);
}

bool set_table::hurry(time_point now) {
  const bool is_news = now < due_;
  due_ = std::min(due_, now);
  return is_news;
}

void set_table::forgive(const std::string& node) {
  for (auto& [name, x] : sets_)
    if (const auto found = x.nodes.find(node); found != x.nodes.end()) {
      found->second.retry = time_point::min();
      found->second.pause.reset();
    }
}

bool set_table::take_due(time_point now) {
  if (now < due_)
    return false;
  due_ = time_point::max();
  return true;
}

set_table::time_point set_table::next_due() const {
  return due_;
}

std::vector<set_step> set_table::admit(const std::string& set,
                                       const std::vector<set_step>& steps,
                                       size_t being_changed, time_point now) {
  std::vector<set_step> result;
  const auto found = sets_.find(set);
  if (found == sets_.end())
    return result;
  auto& known = found->second;
  const auto at_once = static_cast<size_t>(known.what.request.for_each.at_once);
  size_t under_way = 0;
  for (const auto& [node, work] : known.nodes) {
    under_way += work.under_way ? 1 : 0;
    being_changed += work.under_way == set_action::changes ? 1 : 0;
  }
  const bool may_change = put_back_on(set, steps).empty();
  for (const auto& x : steps) {
    const bool is_idle = x.change.action == set_action::stays && !x.joins;
    if (is_idle || x.is_held || !x.problem.empty()
        || under_way >= limits::task::set_work)
      continue;
    const bool is_change = x.change.action == set_action::changes;
    if (is_change && (!may_change || being_changed >= at_once))
      continue;
    auto& work = known.nodes[x.change.node];
    if (work.under_way)
      continue;
    if (now < work.retry) {
      due_ = std::min(due_, work.retry);
      continue;
    }
    being_changed += is_change ? 1 : 0;
    ++under_way;
    result.push_back(x);
  }
  return result;
}

void set_table::begin(const std::string& set, const set_step& step) {
  const auto found = sets_.find(set);
  if (found == sets_.end())
    return;
  auto& work = found->second.nodes[step.change.node];
  work.under_way = step.change.action;
  if (step.change.action == set_action::changes)
    work.changed_for = found->second.what.record.revision;
}

bool set_table::end(const std::string& set, const std::string& node,
                    const std::string& problem, time_point now) {
  const auto found = sets_.find(set);
  if (found == sets_.end())
    return false;
  auto& work = found->second.nodes[node];
  work.under_way.reset();
  const bool is_news = !problem.empty() && problem != work.problem;
  work.problem = problem;
  if (problem.empty())
    work.pause.reset();
  else
    work.retry = now + work.pause.next();
  return is_news;
}

bool set_table::was_put_back(const std::string& set,
                             const set_step& step) const {
  const auto known = sets_.find(set);
  if (known == sets_.end() || step.put_back.empty())
    return false;
  const auto found = known->second.nodes.find(step.change.node);
  return found != known->second.nodes.end() && !found->second.under_way
         && found->second.changed_for == known->second.what.record.revision;
}

std::string set_table::put_back_on(const std::string& set,
                                   const std::vector<set_step>& steps) const {
  const auto found =
      std::find_if(steps.begin(), steps.end(), [&](const auto& x) {
        return x.change.action == set_action::changes && was_put_back(set, x);
      });
  return found == steps.end() ? "" : found->change.node;
}

std::string set_table::problem(const std::string& set,
                               const set_step& step) const {
  const auto known = sets_.find(set);
  if (known == sets_.end() || !step.problem.empty())
    return step.problem;
  if (step.change.action == set_action::changes && was_put_back(set, step))
    return "its change was put back: " + step.put_back;
  const auto found = known->second.nodes.find(step.change.node);
  return found == known->second.nodes.end() ? "" : found->second.problem;
}

bool set_table::note_counts(const task_set_row& row) {
  const auto found = sets_.find(row.task);
  if (found == sets_.end())
    return false;
  auto counts = std::to_string(row.nodes) + "/" + std::to_string(row.running)
                + "/" + std::to_string(row.pending) + "/"
                + std::to_string(row.problems.size());
  return std::exchange(found->second.counts, counts) != counts;
}

} // namespace roscell
