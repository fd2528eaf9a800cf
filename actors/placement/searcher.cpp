#include "actors/placement/searcher.hpp"

#include "actors/core/watching.hpp"
#include "actors/placement/limits.hpp"
#include "actors/placement/questions/task_allocation.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <set>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

namespace {

using searcher_self = scheduler_actor::stateful_pointer<searcher_state>;

void tally(searcher_self self, const std::variant<task_plan, failure>& outcome,
           std::chrono::duration<double> span) {
  const auto& home = self->state.context;
  home.observe(metric::allocation_seconds, {}, span.count());
  if (const auto* plan = std::get_if<task_plan>(&outcome)) {
    home.count(metric::allocations, {plan->optimal ? "optimal" : "best_found"});
    home.observe(metric::allocation_states, {},
                 static_cast<double>(plan->states));
  } else {
    home.count(metric::allocations, {to_word(std::get<failure>(outcome).code)});
  }
}

caf::result<task_plan> search(searcher_self self, const allocate_task& asked) {
  auto& guard = *self->state.guard;
  std::set<std::string> nodes;
  for (const auto& node : asked.nodes)
    nodes.insert(node.name);
  guard.begin(std::move(nodes));
  const auto begin = std::chrono::steady_clock::now();
  auto outcome = allocate(asked, limits::task::allocation_budget,
                          [&guard] { return guard.must_stop(); });
  if (const auto gone = guard.end(); !gone.empty()) {
    ++self->state.interrupted;
    outcome =
        failure{error_code::conflict,
                "node '" + gone + "' left while the task was being placed",
                "/pipeline", "send the request again"};
  }
  tally(self, outcome, std::chrono::steady_clock::now() - begin);
  if (auto* problem = std::get_if<failure>(&outcome)) {
    ++self->state.refusals;
    return to_error(*problem);
  }
  ++self->state.plans;
  return std::get<task_plan>(std::move(outcome));
}

caf::result<moves_planned> search_moves(searcher_self self,
                                        const plan_moves& asked) {
  auto outcome = plan_better_moves(asked);
  if (auto* problem = std::get_if<failure>(&outcome))
    return to_error(*problem);
  ++self->state.move_plans;
  return std::get<moves_planned>(std::move(outcome));
}

} // namespace

scheduler_actor::behavior_type searcher(searcher_self self,
                                        const actor_context& context,
                                        std::shared_ptr<search_guard> guard,
                                        const scheduler_actor& owner) {
  self->state.context = context;
  self->state.guard = std::move(guard);
  watch_until_own_end(self, owner);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"plans", self->state.plans},
                         {"move_plans", self->state.move_plans},
                         {"refusals", self->state.refusals},
                         {"interrupted", self->state.interrupted}});
      },
      [self](const allocate_task& asked) { return search(self, asked); },
      [self](const plan_moves& asked) { return search_moves(self, asked); },
  };
}

void search_guard::begin(std::set<std::string> nodes) {
  const std::lock_guard<std::mutex> lock{mutex_};
  nodes_ = std::move(nodes);
  gone_.clear();
  stopped_ = false;
}

void search_guard::node_left(const std::string& node) {
  const std::lock_guard<std::mutex> lock{mutex_};
  if (nodes_.count(node) == 0 || stopped_)
    return;
  gone_ = node;
  stopped_ = true;
}

std::string search_guard::end() {
  const std::lock_guard<std::mutex> lock{mutex_};
  nodes_.clear();
  return std::exchange(gone_, {});
}

} // namespace roscell
