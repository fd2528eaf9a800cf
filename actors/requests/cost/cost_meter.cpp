#include "actors/requests/cost/cost_meter.hpp"

#include <utility>

namespace roscell {

cost_meter::cost_meter(reader read) : read_(std::move(read)) {}

void cost_meter::mark(cost_ring::time_point now) {
  std::lock_guard guard{mutex_};
  ring_.mark(now, read_());
}

std::vector<cost_window> cost_meter::windows(cost_ring::time_point now) {
  std::lock_guard guard{mutex_};
  ring_.mark(now, read_());
  return ring_.windows();
}

} // namespace roscell
