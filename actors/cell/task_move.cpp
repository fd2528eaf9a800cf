#include "actors/cell/task_move.hpp"

#include "actors/cell/cell_tasks.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/house/limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/failure.hpp"
#include "schemas/decode.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;

/// One instance that moves.
struct moved_step {
  std::string task;
  std::string old_instance;
  resolved_step step;
  step_allocation place;
  instance_spec spec; ///< Of the new instance.
};

/// One move, as it goes on.
struct task_move {
  std::string node; ///< That is being left.
  std::vector<moved_step> steps;
  size_t open = 0;
  std::optional<failure> problem;
  std::function<void(const failure*)> done;
};

using move_ptr = std::shared_ptr<task_move>;

void fail_with(const move_ptr& move, const failure& why) {
  move->done(&why);
}

std::optional<task_request> request_of(const task_record& record) {
  auto decoded = decode<task_request>(json::parse(record.request));
  if (auto* request = std::get_if<task_request>(&decoded))
    return std::move(*request);
  return std::nullopt;
}

/// The steps of a task that run on the node, resolved anew: the node's own
/// version of a skill may be leaving with it.
std::optional<failure> add_steps(self_pointer self, task_move& move,
                                 const task_record& record) {
  const auto request = request_of(record);
  if (!request)
    return failure{error_code::internal,
                   "task '" + record.task + "' has no request any more"};
  for (size_t i = 0; i < record.specs.size(); ++i) {
    if (record.nodes[i] != move.node)
      continue;
    const auto step = std::find_if(
        request->pipeline.begin(), request->pipeline.end(),
        [&](const auto& x) { return x.id == record.specs[i].step; });
    if (step == request->pipeline.end())
      continue;
    auto resolved = resolve_steps({*step}, self->state.registry.skills(""));
    if (auto* why = std::get_if<failure>(&resolved))
      return *why;
    moved_step moved;
    moved.task = record.task;
    moved.old_instance = record.specs[i].instance;
    moved.step = std::move(std::get<0>(resolved).front());
    move.steps.push_back(std::move(moved));
  }
  return std::nullopt;
}

instance_spec spec_of(const cell_coordinator_state& st, const moved_step& x) {
  allocated_task alone;
  alone.request.task = x.task;
  alone.steps = {x.step};
  alone.plan.allocations = {x.place};
  auto result = make_specs(alone).front();
  complete_spec(st, result);
  return result;
}

void replace_in_reply(task_record& record, const moved_step& x) {
  auto reply = json::parse(record.accepted).get<task_accepted>();
  for (auto& placed : reply.instances)
    if (placed.instance == x.old_instance)
      placed = {placed.step, x.spec.instance, x.place.node};
  for (auto& allocation : reply.allocations)
    if (allocation.step == x.step.step.id)
      allocation = x.place;
  record.accepted = message_json(reply).dump();
}

void erase_spec(task_record& record, const std::string& instance) {
  for (size_t i = 0; i < record.specs.size(); ++i) {
    if (record.specs[i].instance != instance)
      continue;
    record.specs.erase(record.specs.begin() + static_cast<ptrdiff_t>(i));
    record.nodes.erase(record.nodes.begin() + static_cast<ptrdiff_t>(i));
    return;
  }
}

/// Ends one instance wherever it is; how that went is told by its own changes
/// and by the next reconciliation.
void remove(
    self_pointer self, const std::string& node, const std::string& task,
    const std::string& instance, const std::function<void()>& done = [] {}) {
  self->state.registry.erase_instance(instance);
  const auto* entry = self->state.registry.find_name(node);
  if (!entry || !entry->agent)
    return done();
  self->request(entry->agent, limits::task::removal,
                instance_removal{task, instance})
      .then([done](const instances_removed&) { done(); },
            [done](const caf::error&) { done(); });
}

/// The new instances run: the old ones go.
void complete(self_pointer self, const move_ptr& move) {
  auto& st = self->state;
  move->open = move->steps.size();
  for (const auto& x : move->steps) {
    if (auto* entry = st.tasks.find(x.task)) {
      replace_in_reply(entry->record, x);
      erase_spec(entry->record, x.old_instance);
      record_fact(self, {"tasks", x.task, json(entry->record).dump()});
    }
    st.context.tell("instance_moved", x.spec.instance,
                    {{"task", x.task},
                     {"from", move->node},
                     {"to", x.place.node},
                     {"replaces", x.old_instance}});
    remove(self, move->node, x.task, x.old_instance, [move] {
      if (--move->open == 0)
        move->done(nullptr);
    });
  }
}

void undo(self_pointer self, const move_ptr& move) {
  for (const auto& x : move->steps) {
    if (auto* entry = self->state.tasks.find(x.task)) {
      erase_spec(entry->record, x.spec.instance);
      record_fact(self, {"tasks", x.task, json(entry->record).dump()});
    }
    remove(self, x.place.node, x.task, x.spec.instance);
  }
  fail_with(move, *move->problem);
}

void finish_one(self_pointer self, const move_ptr& move) {
  if (--move->open > 0)
    return;
  // A task that was terminated meanwhile takes its new instances with it.
  if (move->problem)
    undo(self, move);
  else
    complete(self, move);
}

void deploy_one(self_pointer self, const move_ptr& move, const moved_step& x) {
  const auto* entry = self->state.registry.find_name(x.place.node);
  auto failed = [self, move, node = x.place.node,
                 step = x.step.step.id](const failure& why) {
    move->problem = why;
    move->problem->message =
        "step '" + step + "' on '" + node + "': " + why.message;
    finish_one(self, move);
  };
  if (!entry || !entry->agent)
    return failed({error_code::conflict, "the node left meanwhile"});
  self->request(entry->agent, limits::task::deployment,
                instance_deployment{x.spec})
      .then([self, move](const instance_deployed&) { finish_one(self, move); },
            [failed](const caf::error& why) { failed(to_failure(why)); });
}

void deploy(self_pointer self, const move_ptr& move, const task_plan& plan) {
  auto& st = self->state;
  for (size_t i = 0; i < move->steps.size(); ++i) {
    auto& x = move->steps[i];
    x.place = plan.allocations[i];
    // Numbered for the scheduler, which wants them unique.
    x.place.step = x.step.step.id;
    x.spec = spec_of(st, x);
    auto* entry = st.tasks.find(x.task);
    if (!entry)
      return fail_with(move,
                       {error_code::conflict,
                        "task '" + x.task + "' was terminated meanwhile"});
    entry->record.specs.push_back(x.spec);
    entry->record.nodes.push_back(x.place.node);
    record_fact(self, {"tasks", x.task, json(entry->record).dump()});
  }
  move->open = move->steps.size();
  for (const auto& x : move->steps)
    deploy_one(self, move, x);
}

void place(self_pointer self, const move_ptr& move,
           std::vector<node_resources> nodes) {
  allocate_task question{move->node, {}, std::move(nodes)};
  for (size_t i = 0; i < move->steps.size(); ++i) {
    question.steps.push_back(move->steps[i].step);
    question.steps.back().step.id += "." + std::to_string(i);
  }
  self->request(self->state.setup.scheduler, limits::local::answer, question)
      .then([self, move](const task_plan& plan) { deploy(self, move, plan); },
            [move](const caf::error& err) {
              auto why = to_failure(err);
              why.message =
                  "the instances of node '" + move->node
                  + "' do not fit on the other members: " + why.message;
              fail_with(move, why);
            });
}

} // namespace

void move_tasks(self_pointer self, const std::string& node,
                const std::vector<std::string>& tasks,
                const std::function<void(const failure*)>& done) {
  auto move = std::make_shared<task_move>();
  move->node = node;
  move->done = done;
  for (const auto& task : tasks)
    if (const auto* entry = self->state.tasks.find(task))
      if (auto why = add_steps(self, *move, entry->record))
        return fail_with(move, *why);
  if (move->steps.empty())
    return done(nullptr);
  self->request(cell_coordinator_actor{self}, limits::local::answer,
                collect_resources{})
      .then(
          [self, move](cell_resources& x) {
            place(self, move, std::move(x.nodes));
          },
          [move](const caf::error& why) { fail_with(move, to_failure(why)); });
}

} // namespace roscell
