#include "actors/instances/instance_words.hpp"

#include "messages/codec/json_codec.hpp"
#include "schemas/utf8.hpp"

namespace roscell {

std::string exit_words(int code) {
  if (code < 0)
    return "in an unknown way";
  if (code > 128)
    return "by signal " + std::to_string(code - 128);
  return "with exit code " + std::to_string(code);
}

std::string last_bytes(const std::string& text, size_t max_bytes) {
  if (text.size() <= max_bytes)
    return text;
  const auto begin = text.size() - max_bytes;
  const auto line = text.find('\n', begin);
  // One endless line is cut, maybe inside a character.
  return line < text.size() - 1 ? text.substr(line + 1)
                                : valid_utf8(text.substr(begin));
}

failure deployment_failure(const instance_row& row) {
  const auto who =
      "instance '" + row.spec.instance + "' on node '" + row.node + "'";
  if (row.state == instance_state::stopped)
    return {error_code::conflict,
            who + " was stopped before it ran: " + row.reason};
  const json details{
      {"instance", row.spec.instance},
      {"node", row.node},
      {"exit_code", row.exit_code < 0 ? json(nullptr) : json(row.exit_code)},
      {"log_tail", row.log_tail}};
  return {error_code::engine_failed,
          who + " failed: " + row.reason,
          {},
          row.log_tail.empty() ? std::string{}
                               : "its last lines are in log_tail",
          details.dump(-1, ' ', false, json::error_handler_t::replace)};
}

kept_log about_log_of(const instance_row& row) {
  constexpr size_t reason_bytes = 256;
  kept_log result;
  result.instance = row.spec.instance;
  result.task = row.spec.task;
  result.step = row.spec.step;
  result.node = row.node;
  result.operation = row.spec.operation;
  result.state = row.state;
  result.exit_code = row.exit_code;
  result.ended_unix_ms = row.since_unix_ms;
  auto reason = row.reason;
  // One that is started again tells of its end only there.
  if (is_live(row.state) && !row.ends.empty()) {
    const auto& end = row.ends.front();
    result.state = instance_state::failed;
    result.exit_code = end.exit_code;
    result.ended_unix_ms = end.unix_ms;
    reason = end.reason;
  }
  result.reason = valid_utf8(reason.substr(0, reason_bytes));
  return result;
}

} // namespace roscell
