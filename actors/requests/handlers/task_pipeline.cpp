#include "actors/requests/handlers/task_pipeline.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/limits.hpp"
#include "actors/placement/reading/step_copies.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "actors/requests/limits.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace roscell {

namespace {

bool has_node(const std::vector<node_resources>& nodes,
              const std::string& name) {
  return std::any_of(nodes.begin(), nodes.end(),
                     [&](const auto& x) { return x.name == name; });
}

/// Those of the request come before those of the nodes.
void add_warnings(task_plan& plan, const std::vector<std::string>& warnings) {
  plan.warnings.insert(plan.warnings.begin(), warnings.begin(), warnings.end());
}

/// Takes nodes away and adds others, with every skill, in the order of names.
std::optional<failure> think_otherwise(const what_if& other,
                                       resolved_task& known) {
  auto& nodes = known.cell.nodes;
  for (size_t i = 0; i < other.without.size(); ++i) {
    if (!has_node(nodes, other.without[i]))
      return failure{error_code::unknown_node,
                     "no active node is named '" + other.without[i] + "'",
                     "/without/" + std::to_string(i),
                     "`roscell nodes` lists them"};
    nodes.erase(std::remove_if(
                    nodes.begin(), nodes.end(),
                    [&](const auto& x) { return x.name == other.without[i]; }),
                nodes.end());
  }
  for (size_t i = 0; i < other.with.size(); ++i) {
    if (has_node(nodes, other.with[i].name))
      return failure{error_code::conflict,
                     "the cell has a node '" + other.with[i].name + "'",
                     "/with/" + std::to_string(i) + "/name",
                     "give it another name, or think the other one away"};
    nodes.push_back(other.with[i]);
    // It has the newest build of each skill.
    for (auto& step : known.steps)
      step.builds.front().nodes.push_back(other.with[i].name);
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const auto& x, const auto& y) { return x.name < y.name; });
  return std::nullopt;
}

} // namespace

void claim(const request_context& context, task_request request,
           outcome<claimed_task> done) {
  auto steps = with_copies(request.pipeline);
  if (auto* why = std::get_if<failure>(&steps))
    return done.fail(std::move(*why));
  request.pipeline = std::get<std::vector<task_step>>(std::move(steps));
  claim_task claim_request{request.task, body_of(request), request.request_id,
                           request.force, request.replace};
  // Without the coordinator nobody wants what is deployed.
  watch_until_own_end(context.self, context.services->coordinator);
  ask<task_claimed>(context, context.services->coordinator, limits::task::claim,
                    std::move(claim_request), done,
                    [self = context.self, done, request](task_claimed claimed) {
                      if (claimed.known)
                        return done.conclude(message_json(claimed.accepted));
                      self->state.claimed = request.task;
                      done.deliver({request, std::move(claimed.cell), {}});
                    });
}

void adopt_plan_query(const request_context& context, task_plan_query query,
                      outcome<claimed_task> done) {
  auto steps = with_copies(query.pipeline);
  if (auto* why = std::get_if<failure>(&steps))
    return done.fail(std::move(*why));
  query.pipeline = std::get<std::vector<task_step>>(std::move(steps));
  ask<cell_resources>(
      context, context.services->coordinator, limits::local::answer,
      collect_resources{}, done, [done, query](cell_resources cell) {
        const auto preempt = query.preempt ? preemption::yes : preemption::none;
        done.deliver({{query.task, query.pipeline, preempt},
                      std::move(cell),
                      {query.without, query.with, query.why}});
      });
}

void resolve_skills(const request_context&, claimed_task task,
                    outcome<resolved_task> done) {
  auto reading =
      read_task(task.request.task, task.request.pipeline,
                {task.cell.skills, task.cell.written, task.cell.topics});
  if (auto* why = std::get_if<failure>(&reading))
    return done.fail(std::move(*why));
  auto& meant = std::get<task_reading>(reading);
  resolved_task known{std::move(task.request), std::move(meant.steps),
                      std::move(meant.warnings), std::move(task.cell),
                      task.other.why};
  if (auto why = think_otherwise(task.other, known))
    return done.fail(std::move(*why));
  done.deliver(std::move(known));
}

void place(const request_context& context, resolved_task task,
           outcome<allocated_task> done) {
  allocate_task question{task.request.task,
                         task.steps,
                         std::move(task.cell.nodes),
                         {},
                         std::move(task.why),
                         true,
                         {}};
  if (task.request.preempt != preemption::none)
    question.evictable = std::move(task.cell.evictable);
  ask<task_plan>(context, context.services->scheduler, limits::task::search,
                 std::move(question), done,
                 [done, request = std::move(task.request),
                  steps = std::move(task.steps),
                  warnings = std::move(task.warnings)](task_plan plan) {
                   add_warnings(plan, warnings);
                   done.deliver({request, steps, std::move(plan)});
                 });
}

void present_plan(const request_context&, allocated_task task,
                  outcome<task_plan> done) {
  done.deliver(std::move(task.plan));
}

void record_plan(const request_context& context, reserved_task held,
                 outcome<intended_task> done) {
  const auto& task = held.task;
  record_intent intent{task.request.task,
                       std::move(held.specs),
                       {},
                       {task.request.task,
                        task.plan.optimal,
                        task.plan.score,
                        task.plan.allocations,
                        {},
                        std::move(held.refused),
                        task.plan.warnings,
                        {},
                        task.plan.preempted}};
  for (const auto& x : task.plan.allocations)
    intent.nodes.push_back(x.node);
  context.home().publish_event(
      events::allocation_chosen, task.request.task,
      {{"score", task.plan.score}, {"allocations", task.plan.allocations}});
  context.history().decide(
      {task.request.task, unix_now_ms(), message_json(task.plan).dump(), ""});
  intended_task next{task.request.task,
                     {},
                     intent.nodes,
                     {},
                     {},
                     task.plan.preempted,
                     task.request.force,
                     task.plan.cpu_floor};
  ask<intent_recorded>(context, context.services->coordinator,
                       limits::task::rollback, std::move(intent), done,
                       [done, next](intent_recorded known) mutable {
                         next.specs = std::move(known.specs);
                         next.agents = std::move(known.agents);
                         next.offers = std::move(known.offers);
                         done.deliver(std::move(next));
                       });
}

namespace {

/// Counts down the steps of one deployment. The first failure decides: the
/// others are not waited for, since all of them are rolled back.
struct deployment_tally {
  std::string task;
  size_t open = 0;
  outcome<deployed_task> done;

  void add_success() {
    if (open > 0 && --open == 0)
      done.deliver({task, std::nullopt});
  }

  void add_failure(failure why) {
    if (open == 0)
      return;
    open = 0;
    done.deliver({task, std::move(why)});
  }
};

failure step_failure(const instance_spec& spec, const std::string& node,
                     const caf::error& error, size_t index) {
  auto why = to_failure(error);
  why.message = "step '" + spec.step + "' on '" + node + "': " + why.message;
  why.where = "/pipeline/" + std::to_string(index);
  return why;
}

} // namespace

namespace {

/// Starts the steps of a task, each once those run whose files it reads. Lives
/// as long as the requests that hold it.
class deploying : public std::enable_shared_from_this<deploying> {
public:
  deploying(const request_context& context, intended_task task,
            const outcome<deployed_task>& done)
      : context_(context), task_(std::move(task)),
        before_(start_order(task_.specs)), tally_{task_.task,
                                                  task_.specs.size(), done} {}

  void begin() {
    for (size_t i = 0; i < before_.size(); ++i)
      if (before_[i].empty())
        start(i);
  }

private:
  void start(size_t i) {
    auto self = shared_from_this();
    context_.call<instance_deployed>(
        task_.agents[i], limits::task::deployment_answer,
        instance_deployment{task_.specs[i], task_.offers[i]},
        [self, i](const instance_deployed&) { self->on_running(i); },
        [self, i](const caf::error& why) {
          self->tally_.add_failure(
              step_failure(self->task_.specs[i], self->task_.nodes[i], why, i));
        },
        task_.nodes[i]);
  }

  /// Others may have waited for this one alone.
  void on_running(size_t ran) {
    tally_.add_success();
    for (size_t i = 0; i < before_.size(); ++i) {
      auto& open = before_[i];
      const auto waited = std::find(open.begin(), open.end(), ran);
      if (waited == open.end())
        continue;
      open.erase(waited);
      if (open.empty() && tally_.open > 0)
        start(i);
    }
  }

  request_context context_;
  intended_task task_;
  std::vector<std::vector<size_t>> before_; ///< Of each step, what must run.
  deployment_tally tally_;
};

} // namespace

void deploy(const request_context& context, intended_task task,
            outcome<deployed_task> done) {
  std::make_shared<deploying>(context, std::move(task), done)->begin();
}

namespace {

void record_success(const request_context& context, const std::string& task,
                    const outcome<task_accepted>& done) {
  ask<task_accepted>(
      context, context.services->coordinator, limits::task::rollback,
      record_running{task}, done,
      [done](task_accepted reply) { done.deliver(std::move(reply)); });
}

} // namespace

void undo_placement(const request_context& context, const std::string& task,
                    failure why,
                    const std::function<void(const failure&)>& done) {
  context.self->state.claimed.clear();
  record_failure event{task, why.message};
  why.hint = "the other steps were rolled back"
             + (why.hint.empty() ? "" : "; " + why.hint);
  context.call<task_rolled_back>(
      context.services->coordinator, limits::task::rollback, std::move(event),
      [done, why](const task_rolled_back&) { done(why); },
      [done](const caf::error& error) { done(to_failure(error)); });
}

void record_result(const request_context& context, deployed_task task,
                   outcome<task_accepted> done) {
  if (!task.problem)
    return record_success(context, task.task, done);
  undo_placement(context, task.task, *task.problem,
                 [done](const failure& why) { done.fail(why); });
}

} // namespace roscell
