#pragma once

#include "messages/instance.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell {

/// A log that outlives its instance, and how that ended.
struct kept_log {
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  std::string operation;                          ///< What the skill does.
  instance_state state = instance_state::stopped; ///< Its last one.
  int exit_code = -1;          ///< 128 + n after signal n; negative: not known.
  std::string reason;          ///< Why it ended, one sentence.
  int64_t started_unix_ms = 0; ///< 0: not known.
  int64_t ended_unix_ms = 0;
  int64_t bytes = 0; ///< Of the log on the disk.

  static constexpr auto fields() {
    return field_list{required("instance", &kept_log::instance),
                      optional("task", &kept_log::task),
                      optional("step", &kept_log::step),
                      optional("node", &kept_log::node),
                      optional("operation", &kept_log::operation),
                      required("state", &kept_log::state),
                      nullable("exit_code", &kept_log::exit_code),
                      optional("reason", &kept_log::reason),
                      optional("started_unix_ms", &kept_log::started_unix_ms),
                      required("ended_unix_ms", &kept_log::ended_unix_ms),
                      optional("bytes", &kept_log::bytes)};
  }
};

/// Which logs of instances that are gone are there? A coordinator asks its
/// members the same.
struct kept_logs_query {
  static constexpr const char* type = "kept_logs_query";
  std::string instance; ///< Empty: of every instance.
  std::string task;     ///< Empty: of every task.

  static constexpr auto fields() {
    return field_list{optional("instance", &kept_logs_query::instance),
                      optional("task", &kept_logs_query::task)};
  }
};

struct kept_logs {
  static constexpr const char* type = "kept_logs";
  std::vector<kept_log> logs;      ///< The newest end first; at most 1,000.
  int64_t unreadable = 0;          ///< What else lies there and cannot be read.
  std::vector<std::string> silent; ///< Nodes that have not answered.

  static constexpr auto fields() {
    return field_list{required("logs", &kept_logs::logs),
                      optional("unreadable", &kept_logs::unreadable),
                      optional("silent", &kept_logs::silent)};
  }
};

} // namespace roscell
