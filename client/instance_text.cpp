#include "client/instance_text.hpp"

#include "client/value_text.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace roscell {

bool is_unknown(const instance_row& row) {
  return row.unknown_since_unix_ms != 0;
}

std::string state_text(const instance_row& row) {
  if (is_unknown(row))
    return "unknown";
  return row.health == instance_health::good
                 || row.state != instance_state::running
             ? to_string(row.state)
             : to_string(row.state) + ", " + to_string(row.health);
}

bool runs_well(const instance_row& row) {
  return !is_unknown(row) && row.state == instance_state::running
         && row.health == instance_health::good && row.metrics.remark.empty();
}

std::string since_text(const instance_row& row, int64_t now_unix_ms) {
  return format_since(is_unknown(row) ? row.unknown_since_unix_ms
                                      : row.since_unix_ms,
                      now_unix_ms);
}

std::string not_stop_safe_text(const instance_row& row, int64_t now_unix_ms) {
  auto text = "waits to be stop-safe, "
              + format_since(row.unsafe_since_unix_ms, now_unix_ms);
  if (row.unsafe_until_unix_ms > 0)
    text += "; it ends in "
            + format_since(now_unix_ms, row.unsafe_until_unix_ms)
            + " all the same";
  return text;
}

std::string safety_text(const instance_row& row) {
  if (!row.spec.life.safe_state)
    return {};
  switch (row.safe) {
  case safe_word::safe:
    return "yes";
  case safe_word::unsafe:
    return "no";
  default:
    return "no, it has said nothing yet";
  }
}

namespace {

std::string next_start_text(const instance_row& row, int64_t now_unix_ms) {
  if (row.next_start_unix_ms == 0)
    return row.waits;
  return "next start in "
         + format_since(now_unix_ms,
                        std::max(now_unix_ms, row.next_start_unix_ms));
}

} // namespace

std::string remark(const instance_row& row, int64_t now_unix_ms) {
  if (row.unknown_since_unix_ms != 0)
    return "its node is away; it was " + to_string(row.state)
           + (row.waits.empty() ? "" : "; " + row.waits);
  if (row.unsafe_since_unix_ms != 0)
    return not_stop_safe_text(row, now_unix_ms);
  if (row.state == instance_state::backing_off)
    return next_start_text(row, now_unix_ms) + "; " + row.reason;
  if (row.health != instance_health::good)
    return row.health_reason;
  if (row.state == instance_state::running && !row.metrics.remark.empty())
    return row.metrics.remark;
  if (!row.reason.empty())
    return row.reason;
  if (!row.problem.empty())
    return row.problem;
  // The columns say it better.
  auto reported = row.metrics;
  reported.use = {};
  return reported == instance_metrics{} ? row.status : "";
}

std::string stream_text(const stream_count* count) {
  if (count == nullptr)
    return {};
  std::vector<std::string> words;
  if (count->rate_hz >= 0)
    words.push_back(format_number(count->rate_hz, 1) + " Hz");
  words.push_back(std::to_string(count->frames) + " frames");
  if (count->failed > 0)
    words.push_back(std::to_string(count->failed) + " failed");
  if (count->dropped > 0)
    words.push_back(std::to_string(count->dropped) + " dropped");
  if (count->latency_ms >= 0)
    words.push_back(format_number(count->latency_ms, 2) + " ms");
  return joined(words, ", ");
}

std::string streams_text(const instance_row& row) {
  std::vector<std::string> words;
  const auto add = [&](const char* direction, const io_endpoint& end,
                       const stream_count* count) {
    if (count != nullptr)
      words.push_back(direction + end.endpoint + " " + stream_text(count));
  };
  for (size_t i = 0; i < row.spec.input.size(); ++i)
    add("in ", row.spec.input[i], input_count(row, i));
  for (size_t i = 0; i < row.spec.output.size(); ++i)
    add("out ", row.spec.output[i], output_count(row, i));
  return joined(words, "; ");
}

std::string memory_text(const instance_row& row) {
  const auto& use = row.metrics.use;
  if (use.memory_mib < 0)
    return {};
  const auto bound = use.memory_limit_mib >= 0 ? use.memory_limit_mib
                                               : row.spec.resources.memory_mib;
  return format_memory(use.memory_mib)
         + (bound > 0 ? " of " + format_memory(bound) : "");
}

std::string cpu_text(const instance_row& row) {
  const auto& use = row.metrics.use;
  const auto asked = row.spec.resources.cpu;
  if (use.cpu < 0)
    return {};
  return format_number(use.cpu, 2)
         + (asked > 0 ? " of " + format_number(asked) : "");
}

bool takes_too_much(const instance_row& row) {
  constexpr double nearly = 0.95;
  const auto& use = row.metrics.use;
  const auto asked = row.spec.resources.memory_mib;
  return (asked > 0 && use.memory_mib > asked)
         || (use.memory_limit_mib > 0
             && use.memory_mib > nearly * use.memory_limit_mib);
}

std::string number_with_unit(double value, int decimals, const char* unit) {
  return value < 0 ? "" : format_number(value, decimals) + unit;
}

std::string count_text(int64_t count) {
  return count < 0 ? "" : std::to_string(count);
}

} // namespace roscell
