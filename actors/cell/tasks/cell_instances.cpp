#include "actors/cell/tasks/cell_instances.hpp"

#include "actors/cell/cell_figures.hpp"
#include "actors/cell/moves/lost_steps.hpp"
#include "actors/cell/moves/rebalancing.hpp"
#include "actors/cell/state/task_story.hpp"
#include "actors/cell/streams/cell_streams.hpp"
#include "actors/cell/tasks/node_names.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

/// Whether a task wants the node to keep it.
bool is_wanted(const cell_coordinator_state& st, const std::string& instance,
               const std::string& node) {
  const auto* placed = st.deployments.find(instance, node);
  return placed && st.tasks.is_kept(placed->spec.task)
         && !st.losses.is_given_up(instance);
}

/// What running tasks want on a node, without what has ended.
std::vector<instance_spec> to_be_run_on(const cell_coordinator_state& st,
                                        const node_identity& node) {
  std::vector<instance_spec> result;
  for (const auto& [task, entry] : st.tasks.entries()) {
    if (!st.tasks.is_running(task))
      continue;
    for (const auto& x : st.deployments.of_task(task))
      if (x.node == node.name && !x.end && !x.tentative
          && !st.losses.is_given_up(x.spec.instance)
          && !is_elsewhere(st, x.spec.instance, node.uuid))
        result.push_back(x.spec);
  }
  return result;
}

/// Keep, stop or start: what shall become of the instances of a node, given
/// what it runs and what the tasks want of it.
std::vector<instance_verdict> reconcile(const cell_coordinator_state& st,
                                        const node_registration& node) {
  std::vector<instance_verdict> result;
  std::set<std::string> known;
  for (const auto& x : node.instances) {
    const auto& id = x.spec.instance;
    const bool wanted = is_wanted(st, id, node.identity.name);
    known.insert(id);
    result.push_back({id, wanted ? verdict::keep : verdict::stop, {}});
  }
  for (const auto& spec : to_be_run_on(st, node.identity))
    if (known.count(spec.instance) == 0)
      result.push_back({spec.instance, verdict::start, {spec}});
  return result;
}

/// Carries out a verdict on the coordination node itself. How it went is told
/// by the instance's own changes.
void apply_here(coordinator_pointer self, const node_registration& own,
                const instance_verdict& x) {
  const auto ignore = [](const caf::error&) {};
  const auto& agent = self->state.setup.agent;
  if (x.what == verdict::start)
    self->request(agent, limits::task::deployment_answer,
                  instance_deployment{x.spec.front()})
        .then([](const instance_deployed&) {}, ignore);
  if (x.what != verdict::stop)
    return;
  for (const auto& known : own.instances)
    if (known.spec.instance == x.instance)
      self->request(agent, limits::task::removal_answer,
                    instance_removal{known.spec.task, x.instance})
          .then([](const instances_removed&) {}, ignore);
}

/// What nobody wants any more has run on meanwhile, or begun anew.
void tell_unwanted(coordinator_pointer self, const instance_row& x,
                   const std::string& node) {
  json data{{"task", x.spec.task},
            {"step", x.spec.step},
            {"node", node},
            {"state", to_word(x.state)}};
  if (x.since_unix_ms > 0)
    data["for_s"] =
        std::max<int64_t>(0, unix_now_ms() - x.since_unix_ms) / 1000;
  tell_of_task(self, "instance_unwanted", x.spec.task, x.spec.instance, data);
}

/// The node that speaks: a member speaks for its own only.
std::optional<std::string> node_of_sender(coordinator_pointer self) {
  auto& st = self->state;
  const auto sender = self->current_sender();
  if (!sender)
    return std::nullopt;
  if (st.setup.supervisor && st.setup.supervisor == sender)
    return st.setup.self.name;
  std::optional<std::string> result;
  st.registry.for_each([&](registry_entry& entry) {
    if (entry.member && entry.member == sender)
      result = entry.row.identity.name;
  });
  return result;
}

/// Only what a skill says has changed, which no event tells.
bool differs_in_words_only(const instance_row* before, instance_row now) {
  if (before == nullptr || before->figures == now.figures)
    return false;
  now.figures = before->figures;
  now.status = before->status;
  now.node = before->node;
  return *before == now;
}

} // namespace

void tell_change(coordinator_pointer self, instance_row x,
                 const std::string& node) {
  add_verdict(self->state, x);
  json data{{"task", x.spec.task},
            {"step", x.spec.step},
            {"node", node},
            {"state", to_word(x.state)}};
  if (!x.reason.empty())
    data["reason"] = x.reason;
  if (x.exit_code >= 0)
    data["exit_code"] = x.exit_code;
  if (x.restarts > 0)
    data["restarts"] = x.restarts;
  if (x.next_start_unix_ms > 0)
    data["next_start_unix_ms"] = x.next_start_unix_ms;
  if (x.health != instance_health::good)
    data["health"] = to_word(x.health);
  if (!x.health_reason.empty())
    data["health_reason"] = x.health_reason;
  if (!x.waits.empty())
    data["waits"] = x.waits;
  constexpr const char* what = "instance_changed";
  const auto& task = x.spec.task;
  // Of a new start its history has the end before, and that it runs.
  if (x.restarts > 0 && x.state < instance_state::running)
    self->state.context.tell(what, x.spec.instance, data);
  else if (x.restarts > 0 && x.state <= instance_state::backing_off)
    tell_of_repetition(self, what, task, x.spec.instance, data);
  else
    tell_of_task(self, what, task, x.spec.instance, data);
}

namespace {

/// What the coordination node runs, as it would tell it in a registration.
void take_up_own(coordinator_pointer self, instance_description& known) {
  const auto& st = self->state;
  node_registration own;
  own.identity = st.setup.self;
  own.instances = std::move(known.instances);
  follow_own_name(self, own);
  contact_proven fact{st.context.boot_now_ms(self->system()), {}};
  for (const auto& x : take_up_instances(self, own)) {
    apply_here(self, own, x);
    if (x.what != verdict::stop)
      fact.kept.push_back(x.instance);
  }
  self->send(st.setup.supervisor, std::move(fact));
}

} // namespace

void reconcile_own_node(coordinator_pointer self) {
  const auto& st = self->state;
  if (!st.setup.supervisor)
    return;
  self->request(st.setup.supervisor, limits::resource::collection,
                instance_query{})
      .then([self](instance_description& known) { take_up_own(self, known); },
            [self](const caf::error& why) {
              self->state.context.tell("reconciliation_failed",
                                       self->state.setup.self.name,
                                       {{"reason", to_failure(why).message}});
            });
}

std::vector<instance_verdict> take_up_instances(coordinator_pointer self,
                                                const node_registration& node) {
  auto& st = self->state;
  const auto& name = node.identity.name;
  auto verdicts = reconcile(st, node);
  find_steps_of(self, node);
  st.deployments.forget_node(name);
  std::set<std::string> tasks;
  for (auto x : node.instances) {
    if (!is_wanted(st, x.spec.instance, name)) {
      // It is there until the node has ended it.
      if (is_live(x.state)) {
        tell_unwanted(self, x, name);
        st.deployments.tell(name, std::move(x));
      }
      continue;
    }
    // A node that registers says less of an instance than the task knows.
    x.spec = st.deployments.find(x.spec.instance, name)->spec;
    tasks.insert(x.spec.task);
    st.deployments.tell(name, std::move(x));
  }
  // It has just been told what to stop.
  st.desk.removals.forget_node(name);
  for (const auto& task : tasks)
    record_ends(self, task);
  return verdicts;
}

namespace {

bool is_shortened(const instance_spec& x) {
  return x.input.empty() && x.output.empty() && x.parameters.empty()
         && x.environment.empty() && x.arguments.empty();
}

/// Where a whole row does not fit into a frame its node says less of the
/// instance than the task knows.
instance_row with_own_spec(const cell_coordinator_state& st, instance_row row,
                           const std::string& node) {
  const auto* placed = st.deployments.find(row.spec.instance, node);
  if (placed && is_shortened(row.spec))
    row.spec = placed->spec;
  return row;
}

} // namespace

void on_instance_changed(coordinator_pointer self,
                         const instance_changed& fact) {
  auto& st = self->state;
  const auto& x = fact.instance;
  const auto& id = x.spec.instance;
  const auto node = node_of_sender(self);
  if (!node)
    return;
  const bool news = !differs_in_words_only(st.deployments.told(*node, id), x);
  if (is_wanted(st, id, *node) || is_live(x.state))
    st.deployments.tell(*node, with_own_spec(st, x, *node));
  else
    st.deployments.forget_told(*node, id);
  if (x.state != instance_state::running)
    st.streams.forget(id);
  if (news)
    tell_change(self, x, *node);
  if (is_doubtful(st, x))
    look_at_streams(self, x.spec.task);
  watch_moved(self, x);
  if (!is_live(x.state))
    on_instance_gone(self, *node, id);
  if (const auto* placed = st.deployments.find(id, *node))
    record_ends(self, std::string{placed->spec.task});
}

bool has_instances(const cell_coordinator_state& st, const std::string& node) {
  const auto rows = st.deployments.rows_on(node);
  return !st.deployments.bound_to(node).empty()
         || std::any_of(rows.begin(), rows.end(),
                        [](const auto& x) { return is_live(x.state); });
}

} // namespace roscell
