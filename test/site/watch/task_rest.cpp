#include "test/site/watch/task_rest.hpp"

#include "actors/node/node_agent.hpp"
#include "test/site/watch/task_view.hpp"

#include <caf/actor_cast.hpp>

#include <algorithm>

namespace roscell::test {

namespace {

/// Whether nothing can be said of what should run there.
bool is_away(const site_party& x) {
  return x.retired || !x.alive();
}

/// Whether somebody may have brought the node into another cell while its own
/// coordinator did not know: then its step waits for its return.
bool may_have_been_taken(const site& place, const std::string& node) {
  const auto quoted = '"' + node + '"';
  return std::any_of(place.requests.begin(), place.requests.end(),
                     [&](const auto& x) {
                       return x.text.find("cell_formation") != std::string::npos
                              && x.text.find(quoted) != std::string::npos;
                     });
}

std::string step_complaint(const site& place, const site_party& c,
                           const step_view& step) {
  const auto* node = find_party(place, step.node);
  const auto what = "'" + step.instance + "' of " + c.cell;
  if (step.ended || step.starts_again || is_away(*node))
    return {};
  if (!are_cell(c, *node))
    return may_have_been_taken(place, step.node)
               ? ""
               : what + " is placed on " + step.node
                     + ", which is not in the cell; ";
  const auto i = node->programs.find(step.instance);
  const bool runs = i != node->programs.end() && i->second.runs(place.now());
  return runs ? ""
              : what + " neither runs on " + step.node
                    + " nor is its end known; ";
}

std::string table_complaint(const site& place, const site_party& c,
                            const std::vector<task_view>& tasks) {
  std::string result;
  for (const auto& task : tasks) {
    if (task.state == task_state::deploying
        || task.state == task_state::terminating)
      result += "task '" + task.task + "' of " + c.cell + " is "
                + std::string{to_word(task.state)} + "; ";
    for (const auto& step : task.steps)
      result += step_complaint(place, c, step);
  }
  return result;
}

bool wants(const std::vector<task_view>& tasks, const std::string& instance,
           const std::string& node) {
  return std::any_of(tasks.begin(), tasks.end(), [&](const auto& task) {
    return std::any_of(task.steps.begin(), task.steps.end(),
                       [&](const auto& x) {
                         return x.instance == instance && x.node == node;
                       });
  });
}

/// What runs, runs for a task of the cell that its node is in.
std::string program_complaint(const site& place, const site_party& node) {
  std::string result;
  for (const auto& [instance, program] : node.programs) {
    if (!program.runs(place.now()))
      continue;
    const bool wanted = std::any_of(
        place.parties.begin(), place.parties.end(), [&](const auto& c) {
          return c->coordinates && c->cell == program.cell && c->alive()
                 && are_cell(*c, node)
                 && wants(tasks_of(*c), instance, node.name);
        });
    if (!wanted)
      result += "'" + instance + "' runs on " + node.name + " for no task; ";
  }
  return result;
}

bool any_policy(const site& place, instance_policy policy) {
  return std::any_of(place.requests.begin(), place.requests.end(),
                     [&](const auto& x) { return x.policy == policy; });
}

/// What an operator was told about a task holds.
std::string promise_complaint(const site& place, const site_task& x,
                              const std::vector<task_view>& tasks) {
  std::string result;
  bool accepted = false, unknown = false;
  for (const auto& call : x.calls) {
    if (!call.closed && !call.answered())
      result += "no answer to a request for task '" + x.name + "'; ";
    accepted |= call.accepted();
    unknown |= call.closed;
  }
  const auto is_known =
      std::any_of(tasks.begin(), tasks.end(),
                  [&](const auto& task) { return task.task == x.name; });
  if (accepted && !is_known && !x.end_is_wanted()
      && !any_policy(place, instance_policy::terminate))
    result += "task '" + x.name + "' was accepted and is forgotten; ";
  if (!accepted && !unknown && is_known)
    result += "task '" + x.name + "' was refused and is there; ";
  if (is_known && !unknown && !x.calls.empty() && x.calls.back().ends
      && x.last_came_alone)
    result += "task '" + x.name + "' was terminated and is there; ";
  return result;
}

} // namespace

std::string task_complaint(const site& place) {
  std::string result;
  for (const auto& x : place.parties) {
    if (is_away(*x))
      continue;
    result += program_complaint(place, *x);
    if (!x->coordinates)
      continue;
    const auto tasks = tasks_of(*x);
    result += table_complaint(place, *x, tasks);
    for (const auto& task : place.tasks)
      if (task->cell == x->index)
        result += promise_complaint(place, *task, tasks);
  }
  return result;
}

namespace {

size_t reservations_kept(const site_party& x) {
  using pointer = local_agent_actor::stateful_pointer<node_agent_state>;
  auto* actor =
      dynamic_cast<pointer>(caf::actor_cast<caf::abstract_actor*>(x.agent));
  return actor->state.kept.open(actor->clock().now(), {}).size();
}

size_t running_programs(const site& place, const site_party& x) {
  return static_cast<size_t>(
      std::count_if(x.programs.begin(), x.programs.end(),
                    [&](const auto& p) { return p.second.runs(place.now()); }));
}

std::string remains(const site& place, site_party& x) {
  std::string result;
  const auto add = [&](size_t count, const char* what) {
    if (count > 0)
      result += x.name + " has " + std::to_string(count) + " " + what + "; ";
  };
  // A node outside all cells keeps what has ended, for whoever looks at it,
  // until it is in a cell again.
  if (x.coordinates || x.status().state == node_state::member) {
    add(x.programs.size(), "programs");
    add(x.disk["instances"].size(), "records of instances");
  }
  add(running_programs(place, x), "programs that run");
  add(reservations_kept(x), "rooms that it keeps");
  if (!x.coordinates)
    return result;
  add(tasks_of(x).size(), "tasks");
  add(x.disk["tasks"].size(), "records of tasks");
  add(instances_shown(x), "rows of instances");
  return result;
}

/// What the coordinator counts as used once nothing runs any more.
std::string held_room(site& place, const site_party& c) {
  auto reply =
      place.time.ask<cell_resources>(c.coordinator, collect_resources{});
  place.pass(8s);
  std::string result;
  if (!reply->has_value() || !**reply)
    return c.cell + " does not tell its resources; ";
  for (const auto& node : (**reply)->nodes)
    if (node.cpu.used > idle_cpu + 1e-9)
      result += c.cell + " holds room on " + node.name + "; ";
  return result;
}

} // namespace

std::string end_all_tasks(site& place) {
  for (const auto& c : place.parties)
    if (c->coordinates && c->alive())
      for (const auto& task : tasks_of(*c))
        place.time.ask<task_terminated>(c->coordinator,
                                        task_termination{task.task});
  // Room that is kept is given up after a minute.
  place.pass(90s);
  std::string result;
  for (const auto& x : place.parties) {
    if (is_away(*x))
      continue;
    result += remains(place, *x);
    if (x->coordinates)
      result += held_room(place, *x);
  }
  return result;
}

} // namespace roscell::test
