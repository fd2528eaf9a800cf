#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <string>

namespace roscell::cli {

/// Collects events, so that many of them that arrive while somebody is at work
/// are answered by one more look.
class change_signal {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// @param node has to outlive it.
  explicit change_signal(const node_client& node);

  /// Waits for an event since the last call. Throws what ended the events.
  void wait() {
    wait_until(time_point::max());
  }

  /// The same until then. False if there was none.
  bool wait_until(time_point limit);

private:
  void note(const std::exception_ptr& end = nullptr);

  std::mutex mutex_;
  std::condition_variable news_;
  bool changed_ = false;
  std::exception_ptr ended_;
  event_follower events_; // Last: it uses all the others.
};

/// Shows what `fetch` gets now and after every event of the node, on a screen
/// that is drawn anew, or as one JSON document per line whenever it differs
/// from the last. Events that arrive while it works are answered by one
/// fetch. Ends when the node goes, with command_error, or with Ctrl-C.
int watch(const node_client& node, bool as_json,
          const std::function<json()>& fetch,
          const std::function<std::string(const json&)>& view);

} // namespace roscell::cli
