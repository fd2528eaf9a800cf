#include "actors/placement/skill_resolution.hpp"

#include "actors/edge/session/limits.hpp"
#include "schemas/document.hpp"

#include <chrono>
#include <cmath>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// Members of the step's object count more than those of the skill's.
template <class Policy>
Policy merged(const std::string& of_skill, const std::string& of_step) {
  json result = json::object();
  for (const auto* text : {&of_skill, &of_step})
    if (!text->empty())
      result.merge_patch(json::parse(*text));
  return result.get<Policy>();
}

bool has_bound(const stream_bounds& x) {
  return x.min_rate_hz > 0 || x.max_age_s > 0;
}

failure refuse(const std::string& where, std::string message,
               std::string hint) {
  return {error_code::schema_violation, std::move(message), where,
          std::move(hint)};
}

std::string seconds(double value) {
  return std::to_string(std::lround(value)) + " s";
}

std::optional<failure> check_restart(const restart_policy& x) {
  if (x.max_delay_s < x.delay_s
      && x.max_delay_s != restart_policy{}.max_delay_s)
    return refuse("/restart/max_delay_s",
                  "the longest pause is shorter than the first one",
                  "make it at least \"delay_s\"");
  return std::nullopt;
}

/// A node that is lost has to be sure that what it runs has ended before it is
/// started elsewhere.
std::optional<failure> check_move(const life_policy& x,
                                  const skill_descriptor& descriptor) {
  if (x.on_node_loss.policy != loss_action::move)
    return std::nullopt;
  if (descriptor.engine == "actor")
    return refuse("/on_node_loss/policy",
                  "an actor skill cannot move when its node is lost: it ends "
                  "with its program only",
                  "say \"wait\"");
  constexpr std::chrono::duration<double> leases = 3 * limits::lease::span;
  const auto longest = x.on_node_loss.after_s - leases.count();
  if (!x.safe_state || (x.safe_timeout_s > 0 && x.safe_timeout_s <= longest))
    return std::nullopt;
  return refuse(
      "/safe_timeout_s",
      "a step that becomes stop-safe before it ends may only move when "
      "its node is lost if it has a time for that",
      longest > 0
          ? "say \"safe_timeout_s\" of at most " + seconds(longest)
                + ", or a longer " + "\"after_s\" than "
                + seconds(x.on_node_loss.after_s)
          : "say a longer \"after_s\" than " + seconds(x.on_node_loss.after_s)
                + ", and \"safe_timeout_s\"");
}

std::optional<failure> check_boot(const life_policy& x,
                                  const skill_descriptor& descriptor) {
  if (x.on_boot != boot_action::start)
    return std::nullopt;
  if (x.on_node_loss.policy == loss_action::move)
    return refuse("/on_boot",
                  "a step that moves when its node is lost may run elsewhere "
                  "by the time its node is back",
                  R"(say "rejoin", or "on_node_loss": {"policy": "wait"})");
  if (x.safe_state && !descriptor.may_start_alone)
    return refuse(
        "/on_boot",
        "a step that has to be stop-safe before it ends does not start "
        "without its coordinator",
        R"(say "rejoin", or in its skill.json "may_start_alone": )"
        "true");
  return std::nullopt;
}

std::optional<failure> check_health(const task_step& step,
                                    const health_policy& x,
                                    const skill_descriptor& descriptor) {
  const bool any = has_bound(x.inputs) || has_bound(x.outputs);
  if (any && descriptor.engine == "ros2_standalone")
    return refuse("/health",
                  "a ROS 2 program that runs as it is does not tell what its "
                  "streams do",
                  "leave \"health\" out");
  if (has_bound(x.inputs) && step.input.empty())
    return refuse("/health/inputs", "the step has no input",
                  "give it one, or leave the bounds out");
  if (has_bound(x.outputs) && step.output.empty())
    return refuse("/health/outputs", "the step has no output",
                  "give it one, or leave the bounds out");
  return std::nullopt;
}

} // namespace

life_policy life_of(const task_step& step, const deployment_option& option,
                    bool safe_state) {
  life_policy result;
  result.restart = merged<restart_policy>(option.restart, step.restart);
  result.on_node_loss =
      merged<node_loss_policy>(option.on_node_loss, step.on_node_loss);
  result.health = merged<health_policy>(option.health, step.health);
  result.safe_state = safe_state;
  result.safe_timeout_s =
      step.safe_timeout_s > 0 ? step.safe_timeout_s : option.safe_timeout_s;
  result.priority = step.priority;
  const auto& word = step.on_boot.empty() ? option.on_boot : step.on_boot;
  if (!word.empty())
    result.on_boot = json(word).get<boot_action>();
  return result;
}

std::optional<failure> check_life(const task_step& step,
                                  const deployment_option& option,
                                  const skill_descriptor& descriptor) {
  const auto life = life_of(step, option, descriptor.safe_state);
  if (auto why = check_restart(life.restart))
    return why;
  if (auto why = check_move(life, descriptor))
    return why;
  if (auto why = check_boot(life, descriptor))
    return why;
  return check_health(step, life.health, descriptor);
}

} // namespace roscell
