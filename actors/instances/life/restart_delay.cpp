#include "actors/instances/life/restart_delay.hpp"

#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roscell {

namespace {

using std::chrono::milliseconds;

constexpr double jitter_share = 0.1;

} // namespace

milliseconds span_of(double seconds) {
  constexpr double most_s = 31'536'000;
  return milliseconds{
      static_cast<int64_t>(std::clamp(seconds, 0.0, most_s) * 1000)};
}

int64_t attempts_before(const restart_policy& policy, const instance_row& row,
                        const run_end& end) {
  const bool long_run =
      end.ran.count() > 0 && end.ran >= span_of(policy.reset_after_s);
  return long_run ? 0 : row.attempts;
}

std::optional<milliseconds> restart_delay(const restart_policy& policy,
                                          const run_end& end, int64_t attempts,
                                          double jitter) {
  const bool wanted =
      policy.policy == restart_when::always
      || (policy.policy == restart_when::on_failure && end.failed);
  if (!wanted || (policy.max_attempts > 0 && attempts >= policy.max_attempts))
    return std::nullopt;
  const auto doubled =
      policy.delay_s
      * std::exp2(static_cast<double>(std::min<int64_t>(attempts, 60)));
  const auto delay =
      std::min(doubled, std::max(policy.delay_s, policy.max_delay_s));
  const auto pause =
      span_of(delay * (1 + jitter_share * std::clamp(jitter, 0.0, 1.0)));
  return attempts == 0
             ? pause
             : std::max<milliseconds>(pause, limits::instance::least_pause);
}

milliseconds rest_of_delay(const restart_policy& policy, int64_t until_unix_ms,
                           int64_t now_unix_ms) {
  const auto longest = span_of((1 + jitter_share)
                               * std::max(policy.delay_s, policy.max_delay_s));
  return std::clamp(milliseconds{until_unix_ms - now_unix_ms}, milliseconds{0},
                    longest);
}

void keep_end(instance_row& row, ended_run end) {
  row.ends.insert(row.ends.begin(), std::move(end));
  if (row.ends.size() > limits::instance::kept_ends)
    row.ends.resize(limits::instance::kept_ends);
}

std::string last_lines(const std::string& log) {
  const auto end = log.find_last_not_of('\n');
  if (end == std::string::npos)
    return {};
  auto begin = end + 1;
  for (size_t lines = 0; lines < limits::instance::end_lines; ++lines) {
    const auto before =
        begin < 2 ? std::string::npos : log.rfind('\n', begin - 2);
    begin = before == std::string::npos ? 0 : before + 1;
  }
  return last_bytes(log.substr(begin, end + 1 - begin),
                    limits::instance::end_log_bytes);
}

} // namespace roscell
