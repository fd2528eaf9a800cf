#pragma once

#include "messages/failure.hpp"
#include "messages/messages.hpp"

#include <caf/expected.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What operators ask about tasks, and what they are told.
namespace roscell::test {

using request_reply =
    std::shared_ptr<std::optional<caf::expected<request_routed>>>;

/// One request about a task, sent to the router of its coordinator.
struct task_call {
  bool ends = false; ///< A termination; else a task request.
  std::chrono::steady_clock::time_point when;
  request_reply reply;
  bool closed = false; ///< The coordinator was killed, so the caller knows.

  bool answered() const {
    return reply->has_value();
  }

  /// The reply document, or null while there is none.
  json document() const;

  bool accepted() const;
  bool refused() const;
};

/// Everything that was asked about one task of one cell.
struct site_task {
  size_t cell = 0; ///< Index of its coordinator.
  std::string name;
  json request;
  std::vector<task_call> calls;

  /// Whether an operator has asked for its end.
  bool end_is_wanted() const;

  /// Whether the last one to ask did so when all others had their answers.
  bool last_came_alone = true;
};

} // namespace roscell::test
