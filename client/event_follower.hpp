#pragma once

#include "actors/edge/http/client/http_client.hpp"
#include "messages/event.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace roscell {

/// Puts the lines of a text/event-stream together to events. Unknown fields,
/// comments, and data that is no event are skipped, so that a newer node can
/// say more than this program knows.
class event_stream {
public:
  /// Takes one line without its end. Returns the event that it completes.
  std::optional<event> add_line(std::string_view line);

private:
  std::string data_;
};

/// Sequence number after which nothing is kept: gives the events from now on.
inline constexpr uint64_t from_now_on = 9007199254740991;

/// Follows the events of a node on a thread of its own. What the node has kept
/// since the last one comes first, so that none is missed and none comes twice;
/// numbers go on when a node is started again.
class event_follower {
public:
  using line_handler = std::function<bool(std::string_view line)>;

  /// Gives the lines of what is at a path of the node to `on_line`, until it
  /// ends, or is cancelled. Throws why it cannot.
  using line_reader =
      std::function<void(const std::string& path, const line_handler& on_line,
                         const http_cancel& cancel)>;

  /// All are called on the follower's thread; what the first two throw ends the
  /// stream as if the reader had.
  struct hooks {
    /// Nothing is missed from now on; the node has kept these until then.
    std::function<void(std::vector<event> kept)> on_open;
    std::function<void(event e)> on_event;
    /// The events have ended, or cannot be had; null: the node has ended them.
    /// Returns whether the node is to be looked for again, after a pause that
    /// grows.
    std::function<bool(std::exception_ptr why)> on_end;
  };

  /// @param since the event after which they are wanted; 0: the oldest one.
  event_follower(line_reader read, hooks calls, uint64_t since = from_now_on);
  ~event_follower();

  event_follower(const event_follower&) = delete;
  event_follower& operator=(const event_follower&) = delete;

  /// Looks for a node that is away at once, not after a pause.
  void look_now();

  /// Used when this is destroyed: for what its hooks ask the node.
  const http_cancel& cancel() const {
    return cancel_;
  }

private:
  void run();
  void follow_once();
  std::vector<event> kept_events();

  /// Waits for the next attempt; false: there is to be none.
  bool pause();

  line_reader read_;
  hooks calls_;
  uint64_t last_;
  std::chrono::milliseconds pause_;
  http_cancel cancel_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  bool ended_ = false;
  bool hurries_ = false;
  std::thread thread_; // Last: it uses all the others.
};

} // namespace roscell
