#include "actors/cell/cell_tasks.hpp"

#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;

void tell_store_failed(self_pointer self, const std::string& task,
                       const caf::error& why) {
  self->state.context.tell("store_failed", task,
                           {{"reason", to_failure(why).message}});
}

/// Writes a record, then calls `done`. A store that fails is told of, and does
/// not stop the work: a robot with a full disk still has to be commanded.
void store(
    self_pointer self, const task_record& record,
    const std::function<void()>& done = [] {}) {
  const auto& st = self->state;
  if (!st.setup.store)
    return done();
  self->request(st.setup.store, limits::store::write,
                store_record{"tasks", record.task, json(record).dump()})
      .then([done](const record_stored&) { done(); },
            [self, done, task = record.task](const caf::error& why) {
              tell_store_failed(self, task, why);
              done();
            });
}

void unstore(self_pointer self, const std::string& task) {
  if (self->state.setup.store)
    self->request(self->state.setup.store, limits::store::write,
                  store_record{"tasks", task, ""})
        .then([](const record_stored&) {},
              [self, task](const caf::error& why) {
                tell_store_failed(self, task, why);
              });
}

void grant(self_pointer self, const claim_task& request,
           const caf::actor_addr& owner,
           caf::typed_response_promise<task_claimed> promise);

/// Answers a claim whose task is known. True if that settles it.
bool answer_known(self_pointer self, const claim_task& request,
                  caf::typed_response_promise<task_claimed>& promise) {
  auto* entry = self->state.tasks.find(request.task);
  if (!entry)
    return false;
  if (entry->record.request != request.request)
    promise.deliver(fail(error_code::task_exists,
                         "task '" + request.task + "' exists with another body",
                         "/task",
                         "choose another task id, or terminate this one"));
  else if (entry->record.state == task_state::terminating)
    promise.deliver(fail(error_code::conflict,
                         "task '" + request.task + "' is being terminated",
                         "/task", "send it again once it has ended"));
  else if (entry->record.state == task_state::running)
    promise.deliver(task_claimed{entry->record.accepted});
  else
    entry->same_requests.push_back(promise);
  return true;
}

/// Gives the turn to the next claim, once nobody has it.
void next_turn(self_pointer self) {
  auto& st = self->state;
  while (st.turn.empty() && !st.waiting.empty()) {
    auto next = std::move(st.waiting.front());
    st.waiting.pop_front();
    if (!answer_known(self, next.request, next.promise))
      grant(self, next.request, next.owner, next.promise);
  }
}

void end_turn(self_pointer self, const std::string& task) {
  if (self->state.turn != task)
    return;
  self->state.turn.clear();
  next_turn(self);
}

void grant(self_pointer self, const claim_task& request,
           const caf::actor_addr& owner,
           caf::typed_response_promise<task_claimed> promise) {
  auto& st = self->state;
  st.turn = request.task;
  auto& entry = st.tasks.add({request.task,
                              request.request,
                              "",
                              task_state::deploying,
                              unix_now_ms(),
                              {},
                              {}});
  entry.owner = owner;
  promise.deliver(task_claimed{});
}

/// Removes a task's instances from every active node that has some of them,
/// then calls `done` with the nodes that are away.
void remove_everywhere(
    self_pointer self, const task_record& record,
    const std::function<void(std::vector<std::string> away)>& done) {
  struct tally {
    size_t open = 1;
    std::set<std::string> away;
  };
  auto state = std::make_shared<tally>();
  auto finish_one = [state, done] {
    if (--state->open == 0)
      done({state->away.begin(), state->away.end()});
  };
  for (const auto& node :
       std::set<std::string>{record.nodes.begin(), record.nodes.end()}) {
    const auto* entry = self->state.registry.find_name(node);
    if (!entry || !entry->agent) {
      state->away.insert(node);
      continue;
    }
    ++state->open;
    self->request(entry->agent, limits::task::removal_answer,
                  instance_removal{record.task, ""})
        .then([finish_one](const instances_removed&) { finish_one(); },
              [state, node, finish_one](const caf::error&) {
                state->away.insert(node);
                finish_one();
              });
  }
  finish_one();
}

/// Tells those who wait for the end of deployments. To be called when a task is
/// no longer being deployed.
void settle_awaited_deployments(self_pointer self) {
  auto& st = self->state;
  auto waiting = std::exchange(st.deployments_awaited, {});
  for (auto& x : waiting)
    if (st.tasks.is_deploying_on(x.node))
      st.deployments_awaited.push_back(std::move(x));
    else
      x.done();
}

/// Forgets a task whose instances have been removed.
task_entry take(self_pointer self, const std::string& task) {
  auto& st = self->state;
  auto entry = std::move(*st.tasks.find(task));
  st.tasks.erase(task);
  unstore(self, task);
  for (const auto& spec : entry.record.specs)
    st.registry.erase_instance(spec.instance);
  settle_awaited_deployments(self);
  return entry;
}

caf::error terminated_meanwhile(const std::string& task) {
  return fail(error_code::conflict,
              "task '" + task + "' was terminated meanwhile", "/task");
}

caf::error node_left(const std::string& node) {
  return fail(error_code::conflict,
              "node '" + node + "' left while the task was being placed",
              "/pipeline", "send the request again");
}

/// Undoes a deployment, then calls `done`.
void roll_back(self_pointer self, const std::string& task,
               const std::string& reason, const std::function<void()>& done) {
  auto* entry = self->state.tasks.find(task);
  entry->record.state = task_state::terminating;
  entry->owner = nullptr;
  remove_everywhere(
      self, entry->record, [self, task, reason, done](const auto&) {
        auto gone = take(self, task);
        for (auto& promise : gone.same_requests)
          promise.deliver(
              fail(error_code::engine_failed,
                   "the first request for this task failed: " + reason, "/task",
                   "send it again"));
        for (auto& promise : gone.terminations)
          promise.deliver(task_terminated{task, {}, {}});
        self->state.context.tell("task_failed", task, {{"reason", reason}});
        end_turn(self, task);
        done();
      });
}

/// Removes the instances of a task that no pipeline works on any more.
void finish_termination(self_pointer self, const task_record& record) {
  remove_everywhere(self, record, [self, task = record.task](const auto& away) {
    auto gone = take(self, task);
    task_terminated reply{task, {}, away};
    for (const auto& spec : gone.record.specs)
      reply.instances.push_back(spec.instance);
    for (auto& waiting : gone.terminations)
      waiting.deliver(reply);
    for (auto& waiting : gone.same_requests)
      waiting.deliver(terminated_meanwhile(task));
    self->state.tasks.remember_ended(reply);
    self->state.context.tell("task_terminated", task,
                             {{"instances", reply.instances},
                              {"pending_nodes", reply.pending_nodes}});
  });
}

} // namespace

void complete_spec(const cell_coordinator_state& st, instance_spec& spec) {
  spec.cell = st.setup.cell;
  // No skill may choose another cell's discovery server.
  for (const auto& [name, value] : st.setup.environment)
    spec.environment[name] = value;
}

void restore_tasks(self_pointer self) {
  for (const auto& record : self->state.setup.tasks) {
    // A task that was being deployed or ended when the coordinator died is
    // dropped: nodes stop its instances when they register.
    if (record.state == task_state::running)
      self->state.tasks.add(record).intent = true;
    else
      unstore(self, record.task);
  }
}

caf::result<task_claimed> claim_turn(self_pointer self,
                                     const claim_task& request) {
  auto& st = self->state;
  // The promise takes the message's sender, so it is looked at before.
  const auto sender = self->current_sender();
  const auto owner = caf::actor_cast<caf::actor_addr>(sender);
  if (sender)
    self->monitor(sender);
  auto promise = self->make_response_promise<task_claimed>();
  if (answer_known(self, request, promise))
    return promise;
  if (st.turn.empty())
    grant(self, request, owner, promise);
  else
    st.waiting.push_back({request, owner, promise});
  return promise;
}

caf::result<agents_found> answer_agents(self_pointer self,
                                        const find_agents& asked) {
  agents_found reply{self->state.setup.cell, {}};
  for (const auto& node : asked.nodes) {
    const auto* member = self->state.registry.find_name(node);
    if (!member || !member->agent)
      return node_left(node);
    reply.agents.push_back(member->agent);
  }
  return reply;
}

caf::result<intent_recorded> hold_resources(self_pointer self,
                                            const record_intent& intent) {
  auto& st = self->state;
  auto* entry = st.tasks.find(intent.task);
  if (!entry || entry->record.state != task_state::deploying)
    return terminated_meanwhile(intent.task);
  intent_recorded reply;
  for (const auto& node : intent.nodes) {
    const auto* member = st.registry.find_name(node);
    if (!member || member->row.state != row_state::active)
      return node_left(node);
    reply.agents.push_back(member->agent);
  }
  reply.specs = intent.specs;
  for (auto& spec : reply.specs)
    complete_spec(st, spec);
  entry->record.specs = reply.specs;
  entry->record.nodes = intent.nodes;
  entry->record.accepted = intent.accepted;
  entry->intent = true;
  auto promise = self->make_response_promise<intent_recorded>();
  store(self, entry->record,
        [promise, reply]() mutable { promise.deliver(std::move(reply)); });
  end_turn(self, intent.task);
  return promise;
}

caf::result<outcome_recorded> settle_task(self_pointer self,
                                          const record_outcome& outcome) {
  auto& st = self->state;
  auto* entry = st.tasks.find(outcome.task);
  // A task that was terminated meanwhile has been settled already.
  if (!entry || entry->record.state != task_state::deploying) {
    if (outcome.running)
      return terminated_meanwhile(outcome.task);
    return outcome_recorded{};
  }
  if (outcome.running) {
    entry->record.state = task_state::running;
    entry->owner = nullptr;
    store(self, entry->record);
    for (auto& promise : std::exchange(entry->same_requests, {}))
      promise.deliver(task_claimed{entry->record.accepted});
    st.context.tell("task_accepted", outcome.task,
                    {{"instances", entry->record.specs.size()}});
    settle_awaited_deployments(self);
    return outcome_recorded{};
  }
  auto promise = self->make_response_promise<outcome_recorded>();
  roll_back(self, outcome.task, outcome.reason,
            [promise]() mutable { promise.deliver(outcome_recorded{}); });
  return promise;
}

caf::result<task_terminated> terminate(self_pointer self,
                                       const task_termination& request) {
  auto& st = self->state;
  auto* entry = st.tasks.find(request.task);
  if (!entry) {
    if (const auto* ended = st.tasks.find_ended(request.task))
      return *ended;
    return fail(error_code::unknown_task,
                "no task '" + request.task + "' is known", "/task",
                "`roscell tasks` lists them");
  }
  auto promise = self->make_response_promise<task_terminated>();
  entry->terminations.push_back(promise);
  if (entry->record.state == task_state::terminating)
    return promise;
  entry->record.state = task_state::terminating;
  end_turn(self, request.task);
  store(self, entry->record);
  // Nothing that the pipeline sends may reach a node after the removal, so the
  // pipeline ends first.
  if (entry->owner)
    self->send_exit(entry->owner, terminated_meanwhile(request.task));
  else
    finish_termination(self, entry->record);
  return promise;
}

void on_pipeline_down(self_pointer self, const caf::actor_addr& gone) {
  auto& waiting = self->state.waiting;
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                               [&](const auto& x) { return x.owner == gone; }),
                waiting.end());
  auto* entry = self->state.tasks.find_owned_by(gone);
  if (!entry)
    return;
  entry->owner = nullptr;
  if (entry->record.state == task_state::terminating)
    finish_termination(self, entry->record);
  else
    roll_back(self, entry->record.task,
              "the request that deployed it has ended", [] {});
}

void after_deployments_on(self_pointer self, const std::string& node,
                          std::function<void()> done) {
  self->state.deployments_awaited.push_back({node, std::move(done)});
  settle_awaited_deployments(self);
}

task_row describe_task(self_pointer self, const task_record& record) {
  task_row result{record.task, record.state, record.submitted_unix_ms, {}};
  for (size_t i = 0; i < record.specs.size(); ++i) {
    const auto* known =
        self->state.registry.find_instance(record.specs[i].instance);
    instance_row row;
    if (known) {
      row = *known;
    } else {
      row.spec = record.specs[i];
      row.node = record.nodes[i];
    }
    const auto* node = self->state.registry.find_name(row.node);
    const bool healthy = row.state == instance_state::running && node
                         && node->row.state == row_state::active;
    if (record.state == task_state::running && !healthy)
      result.state = task_state::degraded;
    result.instances.push_back(std::move(row));
  }
  return result;
}

} // namespace roscell
