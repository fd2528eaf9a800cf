#include "actors/cell/tasks/cell_instances.hpp"

#include "actors/cell/cell_questions.hpp"
#include "actors/cell/limits.hpp"
#include "actors/cell/moves/abandoned_steps.hpp"
#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/streams/cell_streams.hpp"
#include "actors/cell/tasks/parameter_changes.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/updates/task_updates.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

/// Whether a task wants the node to keep it. What has ended there is shown as
/// long as its task is; what runs though it is over is ended.
bool is_wanted(const cell_coordinator_state& st, const instance_row& x,
               const std::string& node) {
  const auto& instance = x.spec.instance;
  const auto* placed = st.deployments.find(instance, node);
  return placed && st.tasks.is_kept(placed->spec.task)
         && !(placed->end && is_live(x.state))
         && !st.failures.is_abandoned(instance);
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
          && !st.orders.is_asked(x.spec.instance)
          && !st.failures.is_abandoned(x.spec.instance)
          && !is_elsewhere(st, x.spec.instance, node.uuid))
        result.push_back(x.spec);
  }
  return result;
}

/// What was told to end, and is not on its node any more: it has ended while
/// nobody heard of it.
std::vector<ordered_end> ended_by_order(const cell_coordinator_state& st,
                                        const node_registration& node) {
  std::set<std::string> known;
  for (const auto& x : node.instances)
    known.insert(x.spec.instance);
  std::vector<ordered_end> result;
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& order : entry.orders) {
      const auto* x = st.orders.find(order.instance);
      if (x && !x->held && st.orders.is_asked(order.instance)
          && known.count(order.instance) == 0
          && st.deployments.find(order.instance, node.identity.name))
        result.push_back(*x);
    }
  return result;
}

/// Whether an order to end stands: its node knows of it, or somebody takes care
/// of it, or there is none.
bool is_to_end(const cell_coordinator_state& st, const instance_row& x) {
  const auto* order = st.orders.find(x.spec.instance);
  return !order || order->held || x.unsafe_since_unix_ms > 0;
}

/// A node registers without something that is waited for: it has ended while
/// nobody heard of it.
void settle_waits(coordinator_pointer self, const node_registration& node) {
  std::set<std::string> live;
  for (const auto& x : node.instances)
    if (is_live(x.state))
      live.insert(x.spec.instance);
  const auto waits = self->state.pending.not_stop_safe;
  for (const auto& x : waits)
    if (x.wait.node == node.identity.name && live.count(x.wait.instance) == 0)
      on_instance_gone(self, x.wait.node, x.wait.instance);
}

/// Whether another instance of the step may run, so that this one must not
/// begin anew where it does not run at present: it waits until that has ended.
bool is_held(coordinator_pointer self, const instance_spec& spec,
             const node_identity& node) {
  const auto& st = self->state;
  const auto held = st.failures.hold(spec.task, spec.step, self->clock().now(),
                                     spec.instance);
  // What waits for another node of the cell is no reason not to run here,
  // unless two of them would move the same robot.
  if (!held
      || (held->place.silent_since && held->place.rule == away_rule::waits
          && !spec.life.safe_state))
    return false;
  if (const auto* placed = st.deployments.find(spec.instance, node.name))
    abandon_own_start(self, *placed, node.uuid);
  return true;
}

/// Keep, stop or start: what shall become of the instances of a node, given
/// what it runs and what the tasks want of it.
std::vector<instance_verdict> reconcile(coordinator_pointer self,
                                        const node_registration& node) {
  const auto& st = self->state;
  std::vector<instance_verdict> result;
  std::set<std::string> known;
  for (const auto& x : node.instances) {
    const auto& id = x.spec.instance;
    known.insert(id);
    const auto* placed = st.deployments.find(id, node.identity.name);
    const bool wanted = is_wanted(st, x, node.identity.name)
                        && (x.state != instance_state::backing_off
                            || !is_held(self, placed->spec, node.identity));
    result.push_back({id, wanted ? verdict::keep : verdict::stop, {}});
  }
  for (const auto& spec : to_be_run_on(st, node.identity))
    if (known.count(spec.instance) == 0 && !is_held(self, spec, node.identity)
        && note_start(self, spec, node.identity.name))
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
void publish_unwanted(coordinator_pointer self, const instance_row& x,
                      const std::string& node) {
  json data{{"task", x.spec.task},
            {"step", x.spec.step},
            {"node", node},
            {"state", to_word(x.state)}};
  if (x.since_unix_ms > 0)
    data["for_s"] =
        std::max<int64_t>(0, unix_now_ms() - x.since_unix_ms) / 1000;
  publish_task_event(self, events::instance_unwanted, x.spec.task,
                     x.spec.instance, data);
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
bool differs_in_text_only(const instance_row* before, instance_row now) {
  if (before == nullptr || before->metrics == now.metrics)
    return false;
  now.metrics = before->metrics;
  now.status = before->status;
  now.node = before->node;
  return *before == now;
}

/// What the coordination node runs, as it would tell it in a registration.
void take_up_own(coordinator_pointer self, instance_description& known) {
  const auto& st = self->state;
  node_registration own;
  own.identity = st.setup.self;
  own.instances = std::move(known.instances);
  follow_own_name(self, own);
  contact_proven event{st.context.boot_now_ms(self->system()), {}};
  for (const auto& x : take_up_instances(self, own)) {
    apply_here(self, own, x);
    if (x.what != verdict::stop)
      event.kept.push_back(x.instance);
  }
  self->send(st.setup.supervisor, std::move(event));
  restate_parameters(self, own);
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
              self->state.context.publish_event(
                  events::reconciliation_failed, self->state.setup.self.name,
                  {{"reason", to_failure(why).message}});
            });
}

std::vector<instance_verdict> take_up_instances(coordinator_pointer self,
                                                const node_registration& node) {
  auto& st = self->state;
  const auto& name = node.identity.name;
  find_steps_of(self, node);
  forget_past_remains(self);
  auto verdicts = reconcile(self, node);
  st.deployments.forget_node(name);
  std::set<std::string> tasks;
  for (auto x : node.instances) {
    if (!is_wanted(st, x, name)) {
      // It is there until the node has ended it.
      if (is_live(x.state)) {
        publish_unwanted(self, x, name);
        st.deployments.note_row(name, std::move(x));
      }
      continue;
    }
    // A node that registers says less of an instance than the task knows.
    x.spec = st.deployments.find(x.spec.instance, name)->spec;
    tasks.insert(x.spec.task);
    st.deployments.note_row(name, std::move(x));
  }
  settle_waits(self, node);
  for (const auto& x : node.instances)
    if (is_live(x.state) && !is_to_end(st, x))
      drop_order(self, x.spec.task, x.spec.instance);
  for (const auto& x : ended_by_order(st, node))
    record_forced_end(self, x.task, x.order.instance, x.order.reason,
                      [](const completion&) {});
  // It has just been told what to stop. Nobody answers to that, so it is asked
  // for until it has ended.
  st.pending.removals.forget_node(name);
  for (const auto& x : node.instances)
    if (is_live(x.state) && !is_wanted(st, x, name))
      st.pending.removals.add({name, x.spec.task, x.spec.instance},
                              self->clock().now());
  set_timer(self);
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
                         const instance_changed& event) {
  auto& st = self->state;
  const auto& x = event.instance;
  const auto& id = x.spec.instance;
  const auto node = node_of_sender(self);
  if (!node)
    return;
  note_reported(self, x, *node);
  const bool news =
      !differs_in_text_only(st.deployments.reported(*node, id), x);
  if (is_wanted(st, x, *node) || is_live(x.state))
    st.deployments.note_row(*node, with_own_spec(st, x, *node));
  else
    st.deployments.forget_reported(*node, id);
  if (x.state != instance_state::running)
    st.streams.forget(id);
  if (news)
    publish_change(self, x, *node);
  if (is_doubtful(st, x))
    check_stream_health(self, x.spec.task);
  watch_moved(self, x);
  watch_updated(self, x);
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
