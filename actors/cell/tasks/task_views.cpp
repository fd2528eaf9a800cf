#include "actors/cell/tasks/task_views.hpp"

#include "actors/cell/moves/abandoned_steps.hpp"
#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/streams/cell_streams.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

namespace roscell {

namespace {

/// What a node that is away runs is not known: it runs on as it was, it has
/// ended, or the machine is off.
instance_row shown(const cell_coordinator_state& st, instance_row row) {
  if (is_live(row.state) && !is_present(st, row.node)) {
    const auto* node = st.registry.find_name(row.node);
    row.unknown_since_unix_ms =
        node ? node->row.since_unix_ms : row.since_unix_ms;
    row.metrics = {};
  }
  if (row.unknown_since_unix_ms > 0)
    row.waits = wait_of_lost(st, row);
  else
    add_verdict(st, row);
  return row;
}

/// What of a running task is to be worried about: all but what runs, and what
/// has done its work.
bool is_healthy(const cell_coordinator_state& st, const deployment& x) {
  if (x.end)
    return x.end->state == instance_state::stopped && x.end->exit_code == 0;
  const auto* row = st.deployments.reported(x.node, x.spec.instance);
  if (!row)
    return false;
  if (row->state == instance_state::stopped)
    return row->exit_code == 0;
  return row->state == instance_state::running
         && health_of(st, x.spec.instance, row->state, row->health)
                == instance_health::good
         && is_present(st, x.node);
}

} // namespace

task_state state_of_task(const cell_coordinator_state& st,
                         const std::string& task, const task_entry& entry) {
  if (entry.ending)
    return task_state::terminating;
  const auto& steps = st.deployments.of_task(task);
  const bool is_well =
      std::all_of(steps.begin(), steps.end(),
                  [&](const auto& x) { return is_healthy(st, x); });
  return entry.state == task_state::running && !is_well ? task_state::degraded
                                                        : entry.state;
}

namespace {

/// The labels of a task, which its request has.
std::map<std::string, std::string> task_labels(const task_entry& entry) {
  // Few have any, and a request may be long.
  if (entry.request.find("\"labels\"") == std::string::npos)
    return {};
  const auto request = request_of(entry);
  return request ? request->labels : std::map<std::string, std::string>{};
}

task_row describe_task(const cell_coordinator_state& st,
                       const std::string& task, const task_entry& entry) {
  task_row result{task,
                  state_of_task(st, task, entry),
                  entry.submitted_unix_ms,
                  entry.ended_unix_ms,
                  {},
                  entry.run,
                  entry.deadline_unix_ms,
                  entry.revisions.revision,
                  st.updates.text(task),
                  entry.update.problem,
                  task_labels(entry),
                  entry.set};
  for (const auto& x : st.deployments.of_task(task))
    result.instances.push_back(shown(st, st.deployments.row_of(x)));
  sort_by_flow(result.instances);
  return result;
}

task_found found_as(task_state state) {
  switch (state) {
  case task_state::finished:
    return task_found::finished;
  case task_state::failed:
    return task_found::failed;
  case task_state::degraded:
    return task_found::degraded;
  default:
    return task_found::running;
  }
}

/// Why a step does not run as it should, in a sentence.
std::string reason_of(const cell_coordinator_state& st, const deployment& x) {
  const auto row = shown(st, st.deployments.row_of(x));
  if (!row.waits.empty())
    return row.waits;
  if (!row.health_reason.empty())
    return to_string(row.health) + ": " + row.health_reason;
  return row.reason.empty() ? to_string(row.state)
                            : to_string(row.state) + ": " + row.reason;
}

/// Before it is placed a task has nothing to be shown.
bool is_shown(const task_entry& entry) {
  return !entry.accepted.empty();
}

} // namespace

bool is_present(const cell_coordinator_state& st, const std::string& node) {
  const auto* entry = st.registry.find_name(node);
  return entry && entry->agent;
}

caf::error unknown_thing(const std::string& what, const std::string& id) {
  return fail(error_code::unknown_task, "no " + what + " '" + id + "' is known",
              "/" + what, "`roscell " + what + "s` lists them");
}

task_accepted status_reply(const cell_coordinator_state& st,
                           const std::string& task) {
  const auto& entry = *st.tasks.find(task);
  auto result = reply_of(task, entry, st.deployments);
  result.found = found_as(state_of_task(st, task, entry));
  if (result.found != task_found::degraded)
    return result;
  for (const auto& x : st.deployments.of_task(task))
    if (!x.tentative && !is_healthy(st, x))
      result.waits.push_back(
          {x.spec.step, x.spec.instance, x.node, reason_of(st, x)});
  return result;
}

std::vector<task_row> describe_all_tasks(const cell_coordinator_state& st) {
  std::vector<task_row> result;
  for (const auto& [task, entry] : st.tasks.entries())
    if (is_shown(entry))
      result.push_back(describe_task(st, task, entry));
  return result;
}

namespace {

std::vector<task_set_row> describe_all_sets(const cell_coordinator_state& st) {
  std::vector<task_set_row> result;
  for (const auto& set : st.sets.names())
    result.push_back(describe_set(st, set));
  return result;
}

/// Its request, too, from which it can be made anew.
task_description describe_tasks_of_set(const cell_coordinator_state& st,
                                       const std::string& set) {
  task_description result;
  for (const auto& [task, entry] : st.tasks.entries())
    if (is_shown(entry) && entry.set == set)
      result.tasks.push_back(describe_task(st, task, entry));
  result.sets.push_back(describe_set(st, set));
  result.sets.back().request = st.sets.find(set)->record.request;
  return result;
}

} // namespace

std::vector<task_count> count_tasks(const cell_coordinator_state& st) {
  std::vector<task_count> result(enum_words(task_state{}).size());
  for (size_t i = 0; i < result.size(); ++i)
    result[i].state = static_cast<task_state>(i);
  for (const auto& [task, entry] : st.tasks.entries())
    if (is_shown(entry))
      ++result[static_cast<size_t>(state_of_task(st, task, entry))].tasks;
  return result;
}

caf::result<task_description> describe_tasks(const cell_coordinator_state& st,
                                             const task_query& query) {
  if (query.task.empty())
    return task_description{describe_all_tasks(st), describe_all_sets(st)};
  if (st.sets.find(query.task))
    return describe_tasks_of_set(st, query.task);
  const auto* entry = st.tasks.find(query.task);
  if (!entry || !is_shown(*entry))
    return unknown_thing("task", query.task);
  return task_description{{describe_task(st, query.task, *entry)}, {}};
}

std::vector<registry_row> describe_nodes(const cell_coordinator_state& st) {
  auto result = st.registry.rows();
  for (auto& node : result) {
    const auto& name = node.identity.name;
    const bool away = !is_present(st, name);
    if (const auto* drain = st.drains.find(node.identity.uuid))
      node.draining_since_unix_ms = drain->record.since_unix_ms;
    for (auto& row : st.deployments.known_on(name, away))
      node.instances.push_back(shown(st, std::move(row)));
  }
  return result;
}

caf::expected<instance_description>
describe_instances(const cell_coordinator_state& st,
                   const instance_query& query) {
  instance_description result;
  for (auto& node : describe_nodes(st))
    for (auto& x : node.instances)
      if ((query.instance.empty() || x.spec.instance == query.instance)
          && (query.task.empty() || x.spec.task == query.task))
        result.instances.push_back(std::move(x));
  if (!query.instance.empty() && result.instances.empty())
    return unknown_thing("instance", query.instance);
  return result;
}

namespace {

/// An output of one step is the input of another where both are the same.
using stream_key = std::pair<std::string_view, std::string_view>;

stream_key key_of(const io_endpoint& x) {
  return {x.protocol, x.endpoint};
}

/// Walks from the writers of streams to their readers, and leaves out what
/// leads back to where it has come from.
class flow_walk {
public:
  explicit flow_walk(const std::vector<instance_row>& steps)
      : steps_{steps}, state_(steps.size(), unseen), onward_(steps.size()) {
    for (size_t i = 0; i < steps.size(); ++i)
      for (const auto& x : steps[i].spec.input)
        readers_[key_of(x)].push_back(i);
    for (size_t i = 0; i < steps.size(); ++i)
      visit(i);
  }

  /// Of each step how many lie before it on the longest way to it.
  std::vector<size_t> layers() const {
    std::vector<size_t> result(steps_.size(), 0);
    for (auto from = done_.rbegin(); from != done_.rend(); ++from)
      for (const auto to : onward_[*from])
        result[to] = std::max(result[to], result[*from] + 1);
    return result;
  }

private:
  enum state { unseen, open, done };

  void visit(size_t step) {
    if (state_[step] != unseen)
      return;
    state_[step] = open;
    for (const auto& output : steps_[step].spec.output)
      if (const auto found = readers_.find(key_of(output));
          found != readers_.end())
        for (const auto reader : found->second)
          if (state_[reader] != open) {
            onward_[step].push_back(reader);
            visit(reader);
          }
    state_[step] = done;
    done_.push_back(step);
  }

  const std::vector<instance_row>& steps_;
  std::map<stream_key, std::vector<size_t>> readers_;
  std::vector<state> state_;
  std::vector<std::vector<size_t>> onward_;
  std::vector<size_t> done_; // Each behind all that are reached from it.
};

} // namespace

void sort_by_flow(std::vector<instance_row>& steps) {
  const auto layers = flow_walk{steps}.layers();
  std::vector<size_t> order(steps.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t x, size_t y) { return layers[x] < layers[y]; });
  std::vector<instance_row> sorted;
  sorted.reserve(steps.size());
  for (const auto i : order)
    sorted.push_back(std::move(steps[i]));
  steps = std::move(sorted);
}

} // namespace roscell
