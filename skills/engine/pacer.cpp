#include "roscell/skill/pacer.hpp"

#include <algorithm>

namespace roscell::engine {

pacer::pacer(double rate_hz) : due_(stop_event::clock::now()) {
  using namespace std::chrono;
  // A rate near 0 would be a period that no clock can count.
  constexpr auto longest_s = duration<double>{hours{24}}.count();
  if (rate_hz > 0)
    period_ = duration_cast<stop_event::clock::duration>(
        duration<double>{std::min(1 / rate_hz, longest_s)});
}

bool pacer::wait(const stop_event& stop) {
  if (period_ == stop_event::clock::duration::zero())
    return true;
  if (stop.wait_until(due_))
    return false;
  due_ = std::max(due_, stop_event::clock::now()) + period_;
  return true;
}

bool pacer::take_turn() {
  auto now = stop_event::clock::now();
  if (now + period_ / 4 < due_)
    return false;
  due_ = std::max(due_, now) + period_;
  return true;
}

} // namespace roscell::engine
