#include "actors/instances/life/stream_table.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using seconds_double = std::chrono::duration<double>;

/// Words that follow sooner count as one, so that a late one makes no rate of
/// its own.
constexpr std::chrono::milliseconds least_pause{500};

/// Nothing goes faster, and nothing is longer ago.
constexpr double most_reported = 1e9;

double seconds_between(stream_table::time_point from,
                       stream_table::time_point to) {
  return std::min(seconds_double{to - from}.count(), most_reported);
}

} // namespace

void stream_table::stream::begin(int64_t count, time_point now) {
  *this = {};
  words.push_back({count, now});
  frames = count;
  last_frame = now;
}

void stream_table::stream::go_on(int64_t count, time_point now) {
  if (count > frames)
    last_frame = now;
  frames = count;
  const auto& before = words.back();
  if (now - before.when < least_pause)
    return;
  rate_hz = std::min(static_cast<double>(count - before.frames)
                         / seconds_between(before.when, now),
                     most_reported);
  words.push_back({count, now});
  while (words[1].when <= now - window)
    words.pop_front();
  if (!is_steady())
    steady_since.reset();
  else if (!steady_since)
    steady_since = now;
}

bool stream_table::stream::is_steady() const {
  const auto span = words.back().when - words.front().when;
  const auto wanted = static_cast<double>(steady_frames)
                      * (seconds_double{span} / seconds_double{window});
  return span >= window
         && static_cast<double>(words.back().frames - words.front().frames)
                >= wanted;
}

void stream_table::hear(std::vector<stream_count>& reported, time_point now) {
  auto before = std::exchange(known_, {});
  for (auto& x : reported) {
    const auto known = before.find(x.end);
    auto& now_known = known_[x.end];
    if (known == before.end() || x.frames < known->second.frames) {
      now_known.begin(x.frames, now);
    } else {
      now_known = std::move(known->second);
      now_known.go_on(x.frames, now);
    }
    x.rate_hz = now_known.rate_hz;
    x.quiet_s = seconds_between(now_known.last_frame, now);
    if (now_known.steady_since)
      x.steady_s = seconds_between(*now_known.steady_since, now);
  }
}

} // namespace roscell
