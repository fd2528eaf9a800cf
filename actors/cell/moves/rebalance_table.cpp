#include "actors/cell/moves/rebalance_table.hpp"

#include <utility>

namespace roscell {

rebalance_move* rebalance_table::current() {
  return report_.running && next_ > 0 ? &report_.moves[next_ - 1] : nullptr;
}

void rebalance_table::begin(cell_rebalanced plan, bool force) {
  report_ = std::move(plan);
  report_.running = true;
  force_ = force;
  stopped_ = false;
  next_ = 0;
}

const rebalance_move* rebalance_table::begin_next() {
  if (stopped_ || next_ == report_.moves.size()) {
    if (stopped_ && next_ < report_.moves.size())
      report_.problem = "it was stopped";
    end();
    return nullptr;
  }
  auto& result = report_.moves[next_++];
  result.state = move_state::moving;
  return &result;
}

void rebalance_table::settle(const std::string& instance, time_point until) {
  if (auto* x = current()) {
    x->state = move_state::settling;
    settling_ = instance;
    due_ = until;
  }
}

void rebalance_table::complete() {
  if (auto* x = current())
    x->state = move_state::done;
  settling_.clear();
  due_ = time_point::max();
}

void rebalance_table::fail(const std::string& problem) {
  if (auto* x = current())
    x->state = move_state::failed;
  report_.problem = problem;
  end();
}

void rebalance_table::stop() {
  stopped_ = true;
}

void rebalance_table::end() {
  report_.running = false;
  settling_.clear();
  due_ = time_point::max();
}

} // namespace roscell
