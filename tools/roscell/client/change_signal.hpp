#pragma once

#include "client/event_stream.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string_view>
#include <thread>

namespace roscell::cli {

/// Collects events on a thread of its own, so that many of them that arrive
/// while somebody is at work are answered by one more look.
class change_signal {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// @param node has to outlive it.
  explicit change_signal(const node_client& node);
  ~change_signal();

  change_signal(const change_signal&) = delete;
  change_signal& operator=(const change_signal&) = delete;

  /// Waits for an event since the last call. Throws what ended the events.
  void wait();

  /// The same until then. False if there was none.
  bool wait_until(time_point limit);

private:
  void read();
  bool on_line(std::string_view line);
  bool has_news() const;
  void take_news();

  const node_client& node_;
  http_cancel cancel_;
  event_stream events_; // Of the reader alone, as is the next.
  bool open_ = false;
  std::mutex mutex_;
  std::condition_variable news_;
  bool changed_ = false;
  std::exception_ptr ended_;
  std::thread reader_; // Last: it uses all the others.
};

} // namespace roscell::cli
