#include "actors/cell/moves/rebalance_book.hpp"

#include <utility>

namespace roscell {

rebalance_move* rebalance_book::current() {
  return report_.running && next_ > 0 ? &report_.moves[next_ - 1] : nullptr;
}

void rebalance_book::begin(cell_rebalanced plan, bool force) {
  report_ = std::move(plan);
  report_.running = true;
  force_ = force;
  stopped_ = false;
  next_ = 0;
}

const rebalance_move* rebalance_book::begin_next() {
  if (stopped_ || next_ == report_.moves.size()) {
    if (stopped_ && next_ < report_.moves.size())
      report_.trouble = "it was stopped";
    end();
    return nullptr;
  }
  auto& result = report_.moves[next_++];
  result.state = move_state::moving;
  return &result;
}

void rebalance_book::settle(const std::string& instance, time_point until) {
  if (auto* x = current()) {
    x->state = move_state::settling;
    settling_ = instance;
    due_ = until;
  }
}

void rebalance_book::complete() {
  if (auto* x = current())
    x->state = move_state::done;
  settling_.clear();
  due_ = time_point::max();
}

void rebalance_book::fail(const std::string& trouble) {
  if (auto* x = current())
    x->state = move_state::failed;
  report_.trouble = trouble;
  end();
}

void rebalance_book::stop() {
  stopped_ = true;
}

void rebalance_book::end() {
  report_.running = false;
  settling_.clear();
  due_ = time_point::max();
}

} // namespace roscell
