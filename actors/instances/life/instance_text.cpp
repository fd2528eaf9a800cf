#include "actors/instances/life/instance_text.hpp"

#include "actors/instances/life/health_table.hpp"
#include "actors/instances/limits.hpp"
#include "messages/codec/json_codec.hpp"
#include "schemas/utf8.hpp"

#include <cmath>

namespace roscell {

namespace {

/// Endpoints come from checked JSON, but a text that is none must not throw.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace

std::map<std::string, std::string>
instance_environment(const instance_spec& spec,
                     const deployment_option& deployment,
                     const std::map<std::string, std::string>& of_node) {
  using std::chrono::microseconds;
  auto result = of_node;
  result.insert(spec.environment.begin(), spec.environment.end());
  result.insert(deployment.environment.begin(), deployment.environment.end());
  const std::map<std::string, std::string> contract{
      {"ROSCELL_TASK", spec.task},
      {"ROSCELL_STEP", spec.step},
      {"ROSCELL_INSTANCE", spec.instance},
      {"ROSCELL_OPERATION", spec.operation},
      {"ROSCELL_MODEL", spec.model},
      {"ROSCELL_DEPLOYMENT", spec.deployment},
      {"ROSCELL_CELL", spec.cell},
      {"ROSCELL_INPUTS", text_of(spec.input)},
      {"ROSCELL_OUTPUTS", text_of(spec.output)},
      {"ROSCELL_PARAMETERS", spec.parameters.empty() ? "{}" : spec.parameters},
      {"WATCHDOG_USEC",
       std::to_string(
           microseconds{limits::instance::announced_watchdog}.count())},
  };
  for (const auto& [name, value] : contract)
    result[name] = value;
  // To measure costs a skill some wake-ups.
  if (has_bounds(spec.life.health))
    result["ROSCELL_HEALTH"] = "1";
  if (spec.gpu >= 0) {
    // Inside the instance CUDA counts from 0, so both are needed.
    result["ROSCELL_GPU"] = std::to_string(spec.gpu);
    result["CUDA_VISIBLE_DEVICES"] = std::to_string(spec.gpu);
  }
  return result;
}

std::string changeable_parameters(const skill_descriptor& skill,
                                  const std::string& model) {
  auto result = json::object();
  for (const auto& x : skill.models) {
    if (x.name != model || x.parameters.empty())
      continue;
    const auto declared = json::parse(x.parameters, nullptr, false);
    if (!declared.is_object())
      continue;
    for (const auto& [name, what] : declared.items())
      if (what.is_object() && what.value("changeable", false))
        result[name] = what;
  }
  return result.empty() ? std::string{} : text_of(result);
}

std::string exit_code_text(int code) {
  if (code < 0)
    return "in an unknown way";
  if (code > 128)
    return "by signal " + std::to_string(code - 128);
  return "with exit code " + std::to_string(code);
}

namespace {

std::string mib_text(double mib) {
  return std::to_string(std::llround(std::ceil(mib))) + " MiB";
}

/// What it may have and what it took. The kernel counts in portions: one at its
/// bound can be short of it by some.
std::string memory_use_text(double may_have, double took) {
  constexpr double nearly = 0.95;
  const auto has = "it may use " + mib_text(may_have);
  const auto had = "took " + mib_text(took);
  const std::string beginning = "out of memory: ";
  if (may_have > 0 && took < 0)
    return beginning + has;
  if (may_have > 0 && took >= nearly * may_have)
    return beginning + has + ", and " + had;
  return beginning + "its host had no more" + (took < 0 ? "" : "; it " + had)
         + (may_have > 0 ? ", and may use " + mib_text(may_have) : "");
}

} // namespace

std::string end_reason_text(const instance_row& row, end_cause cause,
                            double most_memory_mib) {
  if (cause == end_cause::memory)
    return memory_use_text(row.spec.resources.memory_mib, most_memory_mib);
  if (cause == end_cause::supervision)
    return "its supervision was ended from outside, and its program with it";
  return "it ended " + exit_code_text(row.exit_code);
}

std::string scheduling_word(const scheduling_request& request) {
  if (request == scheduling_request{})
    return {};
  return (request.policy.empty() ? "other" : request.policy) + ':'
         + std::to_string(request.priority) + ':'
         + std::to_string(request.nice);
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
                               : "`roscell logs " + row.spec.instance
                                     + "` shows all that it said",
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
