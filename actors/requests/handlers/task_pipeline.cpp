#include "actors/requests/handlers/task_pipeline.hpp"

#include "actors/house/limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/skill_resolution.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace roscell {

namespace {

std::string text_of(const task_request& request) {
  return message_json(request).dump();
}

bool has_node(const std::vector<node_resources>& nodes,
              const std::string& name) {
  return std::any_of(nodes.begin(), nodes.end(),
                     [&](const auto& x) { return x.name == name; });
}

/// Takes nodes away and adds others, with every skill, in the order of names.
std::optional<failure> think_otherwise(const what_if& other,
                                       resourced_task& known) {
  auto& nodes = known.nodes;
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
  claim_task wish{request.task, text_of(request)};
  ask<task_claimed>(context, context.services->coordinator, limits::task::turn,
                    std::move(wish), done,
                    [done, request](const task_claimed& claimed) {
                      if (claimed.accepted.empty())
                        done.deliver({request, {}});
                      else
                        done.conclude(json::parse(claimed.accepted));
                    });
}

void adopt_plan_query(const request_context&, task_plan_query query,
                      outcome<claimed_task> done) {
  done.deliver({{std::move(query.task), std::move(query.pipeline)},
                {std::move(query.without), std::move(query.with),
                 std::move(query.why)}});
}

void resolve_skills(const request_context& context, claimed_task task,
                    outcome<resolved_task> done) {
  ask<skill_list>(
      context, context.services->coordinator, limits::local::answer,
      skill_query{}, done,
      [done, task = std::move(task)](const skill_list& known) {
        auto steps = resolve_steps(task.request.pipeline, known.skills);
        if (auto* why = std::get_if<failure>(&steps))
          done.fail(std::move(*why));
        else
          done.deliver({task.request,
                        std::get<std::vector<resolved_step>>(std::move(steps)),
                        task.other});
      });
}

void collect(const request_context& context, resolved_task task,
             outcome<resourced_task> done) {
  ask<cell_resources>(context, context.services->coordinator,
                      limits::local::answer, collect_resources{}, done,
                      [done, task = std::move(task)](cell_resources cell) {
                        resourced_task known{task.request, task.steps,
                                             std::move(cell.nodes),
                                             task.other.why};
                        if (auto why = think_otherwise(task.other, known))
                          done.fail(std::move(*why));
                        else
                          done.deliver(std::move(known));
                      });
}

void place(const request_context& context, resourced_task task,
           outcome<allocated_task> done) {
  allocate_task question{task.request.task,     task.steps,
                         std::move(task.nodes), {},
                         std::move(task.why),   true};
  ask<task_plan>(context, context.services->scheduler, limits::task::search,
                 std::move(question), done,
                 [done, request = std::move(task.request),
                  steps = std::move(task.steps)](task_plan plan) {
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
  const auto& specs = held.specs;
  task_accepted reply{task.request.task,
                      task.plan.optimal,
                      task.plan.score,
                      task.plan.allocations,
                      {},
                      held.refused};
  record_intent intent{task.request.task, text_of(task.request), specs, {}, ""};
  for (size_t i = 0; i < specs.size(); ++i) {
    const auto& node = task.plan.allocations[i].node;
    intent.nodes.push_back(node);
    reply.instances.push_back({specs[i].step, specs[i].instance, node});
  }
  intent.accepted = message_json(reply).dump();
  context.home().tell(
      "allocation_chosen", task.request.task,
      {{"score", task.plan.score}, {"allocations", task.plan.allocations}});
  ask<intent_recorded>(
      context, context.services->coordinator, limits::local::answer,
      std::move(intent), done, [done, reply](intent_recorded known) {
        done.deliver({reply, std::move(known.specs), std::move(known.agents)});
      });
}

namespace {

/// Counts down the steps of one deployment. The first failure decides: the
/// others are not waited for, since all of them are rolled back.
struct deployment_tally {
  task_accepted reply;
  size_t open = 0;
  outcome<deployed_task> done;

  void add_success() {
    if (open > 0 && --open == 0)
      done.deliver({reply, std::nullopt});
  }

  void add_failure(failure why) {
    if (open == 0)
      return;
    open = 0;
    done.deliver({reply, std::move(why)});
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

void deploy(const request_context& context, intended_task task,
            outcome<deployed_task> done) {
  auto tally = std::make_shared<deployment_tally>(
      deployment_tally{task.reply, task.specs.size(), done});
  for (size_t i = 0; i < task.specs.size(); ++i) {
    const auto& spec = task.specs[i];
    const auto& node = task.reply.instances[i].node;
    context.self
        ->request(task.agents[i], limits::task::deployment_answer,
                  instance_deployment{spec})
        .then([tally](const instance_deployed&) { tally->add_success(); },
              [tally, spec, node, i](const caf::error& why) {
                tally->add_failure(step_failure(spec, node, why, i));
              });
  }
}

void record_result(const request_context& context, deployed_task task,
                   outcome<task_accepted> done) {
  const bool running = !task.problem;
  record_outcome fact{task.reply.task, running,
                      running ? "" : task.problem->message};
  ask<outcome_recorded>(
      context, context.services->coordinator, limits::task::rollback,
      std::move(fact), done,
      [done, task = std::move(task), running](const outcome_recorded&) {
        if (running)
          return done.deliver(task.reply);
        auto why = *task.problem;
        why.hint = "the other steps were rolled back; " + why.hint;
        done.fail(std::move(why));
      });
}

} // namespace roscell
