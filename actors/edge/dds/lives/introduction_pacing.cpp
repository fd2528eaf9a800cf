#include "actors/edge/dds/lives/introduction_pacing.hpp"

#include <algorithm>

namespace roscell {

bool introduction_pacing::ask(std::uint8_t id, time_point now) {
  auto& x = paces_[id];
  if (now < x.next)
    return false;
  if (now >= x.next + longest_pause)
    x.pause = first_pause;
  x.next = now + x.pause;
  x.pause = std::min(2 * x.pause, longest_pause);
  return true;
}

void introduction_pacing::forget(std::uint8_t id) {
  paces_[id] = {};
}

} // namespace roscell
