#include "actors/instances/life/skill_metrics.hpp"

#include "messages/stream_protocols.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

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

namespace {

/// Shorter times between two words say little of a rate.
constexpr std::chrono::milliseconds least_span{500};

/// Largest number that JSON carries exactly, as its schema says.
constexpr int64_t most = 9'007'199'254'740'991;

/// Nothing goes faster, or takes longer.
constexpr double largest_number = 1e9;

/// A whole number that is not negative; nothing for any other text.
std::optional<int64_t> whole_number(std::string_view text) {
  int64_t result = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  if (error != std::errc{} || rest != end || result < 0 || result > most)
    return std::nullopt;
  return result;
}

double milliseconds_of(int64_t us) {
  return std::min(static_cast<double>(us) / 1000, largest_number);
}

/// One count for each bucket of times; none for any other text.
std::vector<int64_t> counts_in(std::string_view text) {
  constexpr size_t buckets = latency_bounds_ms.size() + 1;
  std::vector<int64_t> result;
  while (result.size() < buckets) {
    const auto end = std::min(text.find(','), text.size());
    const auto count = whole_number(text.substr(0, end));
    const bool is_last = result.size() + 1 == buckets;
    if (!count || is_last != (end == text.size()))
      return {};
    result.push_back(*count);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

void take_word(std::string_view word, instance_metrics& to) {
  const auto equals = word.find('=');
  if (equals == std::string_view::npos)
    return;
  const auto name = word.substr(0, equals);
  const auto text = word.substr(equals + 1);
  if (name == "times") {
    to.latency_counts = counts_in(text);
    return;
  }
  const auto value = whole_number(text);
  if (!value)
    return;
  if (name == "frames")
    to.frames = *value;
  else if (name == "dropped")
    to.dropped = *value;
  else if (name == "median_us")
    to.latency_ms = milliseconds_of(*value);
  else if (name == "times_us")
    to.latency_sum_ms = static_cast<double>(*value) / 1000;
  else if (name == "age_us")
    to.age_ms = milliseconds_of(*value);
}

} // namespace

instance_metrics metrics_in(std::string_view status) {
  instance_metrics result;
  while (!status.empty()) {
    const auto end = std::min(status.find(' '), status.size());
    take_word(status.substr(0, end), result);
    status.remove_prefix(std::min(end + 1, status.size()));
  }
  // A median of no frames is none.
  if (result.frames == 0)
    result.latency_ms = -1;
  // Counts without their sum are no histogram, nor is a sum alone.
  if (result.latency_counts.empty() || result.latency_sum_ms < 0) {
    result.latency_counts.clear();
    result.latency_sum_ms = -1;
  }
  return result;
}

void skill_metrics_table::hear(std::string_view status, time_point now,
                               std::vector<stream_count> streams,
                               std::string remark) {
  const auto rate = known_.rate_hz;
  known_ = metrics_in(status);
  streams_.hear(streams, now);
  known_.streams = std::move(streams);
  known_.remark = std::move(remark);
  if (known_.frames < 0) {
    counted_.reset();
    return;
  }
  known_.rate_hz = rate;
  // Fewer frames than before are those of a program that began anew.
  if (!counted_ || known_.frames < counted_->frames) {
    counted_ = count{known_.frames, now};
    known_.rate_hz = -1;
    return;
  }
  const std::chrono::duration<double> span = now - counted_->when;
  if (span < least_span)
    return;
  known_.rate_hz = std::min(
      static_cast<double>(known_.frames - counted_->frames) / span.count(),
      largest_number);
  counted_ = count{known_.frames, now};
}

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
