#include "actors/instances/life/skill_metrics.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

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

} // namespace roscell
