#include "actors/instances/life/quiet_notice.hpp"

#include "messages/stream_protocols.hpp"

#include <algorithm>

namespace roscell {

bool quiet_notice::hear(const instance_row& row, time_point now) {
  constexpr auto enough_s = std::chrono::duration<double>{quiet_for}.count();
  bool result = false;
  for (size_t i = 0; i < row.spec.input.size(); ++i) {
    if (row.spec.input[i].protocol != protocols::ros2)
      continue;
    const auto end = "input:" + std::to_string(i);
    const auto& all = row.metrics.streams;
    const auto count = std::find_if(
        all.begin(), all.end(), [&](const auto& x) { return x.end == end; });
    if (count == all.end())
      continue;
    auto& known = inputs_[end];
    const bool is_quiet = count->quiet_s >= enough_s;
    if (is_quiet == known.quiet
        || (is_quiet && known.reported && now - *known.reported < pause))
      continue;
    known.quiet = is_quiet;
    known.reported = is_quiet ? now : known.reported;
    result = true;
  }
  return result;
}

} // namespace roscell
