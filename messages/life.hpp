#pragma once

#include "messages/codec/json_codec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// How a step lives: when it is started again, what becomes of it where its
/// node is lost, what its data streams must do, and how it may be ended.
namespace roscell {

/// After which ends an instance is started again.
enum class restart_when {
  on_failure, ///< All but exit code 0.
  always,
  never,
};

constexpr auto enum_words(restart_when) {
  return std::array<std::string_view, 3>{"on_failure", "always", "never"};
}

/// How a node starts again what has ended; by itself, without a coordinator.
struct restart_policy {
  restart_when policy = restart_when::on_failure;
  double delay_s = 1;         ///< Before the first attempt; then twice as long,
  double max_delay_s = 60;    ///< up to this.
  double reset_after_s = 600; ///< Running so long, it begins at the first.
  int64_t max_attempts = 0;   ///< In a row; 0: no limit.

  static constexpr auto fields() {
    return field_list{optional("policy", &restart_policy::policy),
                      optional("delay_s", &restart_policy::delay_s),
                      optional("max_delay_s", &restart_policy::max_delay_s),
                      optional("reset_after_s", &restart_policy::reset_after_s),
                      optional("max_attempts", &restart_policy::max_attempts)};
  }
};

enum class loss_action {
  wait, ///< The step stays with its node.
  move, ///< It is placed anew elsewhere.
};

constexpr auto enum_words(loss_action) {
  return std::array<std::string_view, 2>{"wait", "move"};
}

/// What becomes of a step whose node is lost.
struct node_loss_policy {
  loss_action policy = loss_action::wait;
  double after_s = 60; ///< Lost for so long; at least three leases.

  static constexpr auto fields() {
    return field_list{optional("policy", &node_loss_policy::policy),
                      optional("after_s", &node_loss_policy::after_s)};
  }
};

/// What becomes of a step that its host has interrupted: by a reboot, a loss of
/// power, or a signal to its supervision that its node has not sent.
enum class boot_action {
  usual,  ///< Nobody has said: see `boot_action_of`.
  rejoin, ///< It is started again once the coordinator wants it to go on.
  start,  ///< At once, without a coordinator.
  stay,   ///< It waits until somebody restarts it.
};

constexpr auto enum_words(boot_action) {
  return std::array<std::string_view, 4>{"usual", "rejoin", "start", "stay"};
}

/// What every data stream of one direction must do; 0: no bound.
struct stream_bounds {
  double min_rate_hz = 0;
  double max_age_s = 0; ///< Since the last frame, by the receiver's clock.

  static constexpr auto fields() {
    return field_list{optional("min_rate_hz", &stream_bounds::min_rate_hz),
                      optional("max_age_s", &stream_bounds::max_age_s)};
  }
};

struct health_policy {
  stream_bounds inputs;
  stream_bounds outputs;
  double grace_s = 10; ///< How long a bound may be broken.

  static constexpr auto fields() {
    return field_list{optional("inputs", &health_policy::inputs),
                      optional("outputs", &health_policy::outputs),
                      optional("grace_s", &health_policy::grace_s)};
  }
};

/// All of it, for one instance: the defaults, overridden by the deployment of
/// its skill, overridden by the step.
struct life_policy {
  restart_policy restart;
  node_loss_policy on_node_loss;
  health_policy health;
  bool safe_state = false;   ///< It says when it may be ended.
  double safe_timeout_s = 0; ///< It is ended after so long; 0: never.
  int64_t priority = 5;      ///< 0 to 9; where room is short the lower goes.
  boot_action on_boot = boot_action::usual;

  static constexpr auto fields() {
    return field_list{optional("restart", &life_policy::restart),
                      optional("on_node_loss", &life_policy::on_node_loss),
                      optional("health", &life_policy::health),
                      optional("safe_state", &life_policy::safe_state),
                      optional("safe_timeout_s", &life_policy::safe_timeout_s),
                      optional("priority", &life_policy::priority),
                      optional("on_boot", &life_policy::on_boot)};
  }
};

/// What nobody may find moving, and what runs once, waits for a person, unless
/// it says otherwise.
constexpr boot_action boot_action_of(const life_policy& x) {
  if (x.on_boot != boot_action::usual)
    return x.on_boot;
  return x.safe_state || x.restart.policy == restart_when::never
             ? boot_action::stay
             : boot_action::rejoin;
}

/// What one data stream of an instance does, as its skill has measured it.
struct stream_metrics {
  std::string end;    ///< "input:0", "output:1".
  double rate_hz = 0; ///< Frames a second since the value before.
  double age_s = -1;  ///< Since the last frame; negative: there was none.

  static constexpr auto fields() {
    return field_list{required("end", &stream_metrics::end),
                      required("rate_hz", &stream_metrics::rate_hz),
                      optional("age_s", &stream_metrics::age_s)};
  }
};

/// What its data streams say of an instance that runs.
enum class instance_health {
  good,      ///< Or nothing is known.
  starved,   ///< An input breaks its bounds.
  unhealthy, ///< An output does, while the inputs are fine.
};

constexpr auto enum_words(instance_health) {
  return std::array<std::string_view, 3>{"good", "starved", "unhealthy"};
}

/// Whether an instance may be ended, as its skill has told.
enum class safe_word { untold, unsafe, safe };

constexpr auto enum_words(safe_word) {
  return std::array<std::string_view, 3>{"untold", "unsafe", "safe"};
}

/// One earlier run of an instance.
struct ended_run {
  int64_t unix_ms = 0; ///< When it ended.
  int exit_code = -1;  ///< As in `instance_row`.
  std::string reason;
  std::string log; ///< Its last lines.

  static constexpr auto fields() {
    return field_list{required("unix_ms", &ended_run::unix_ms),
                      nullable("exit_code", &ended_run::exit_code),
                      optional("reason", &ended_run::reason),
                      optional("log", &ended_run::log)};
  }
};

/// An instance that is to end and is not stop-safe yet.
struct safety_wait {
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  int64_t since_unix_ms = 0;
  int64_t until_unix_ms = 0; ///< It is ended then all the same; 0: never.

  static constexpr auto fields() {
    return field_list{required("instance", &safety_wait::instance),
                      required("task", &safety_wait::task),
                      required("step", &safety_wait::step),
                      required("node", &safety_wait::node),
                      required("since_unix_ms", &safety_wait::since_unix_ms),
                      optional("until_unix_ms", &safety_wait::until_unix_ms)};
  }
};

} // namespace roscell
