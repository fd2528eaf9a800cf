#pragma once

#include "tools/roscell/top/follow/mailbox.hpp"
#include "tools/roscell/top/follow/node_link.hpp"

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>

namespace roscell::cli::top {

/// Follows the events of a node on a thread of its own. When they end it says
/// so, and looks for the node again with growing pauses.
class event_follower {
public:
  event_follower(const http_endpoint& node, mailbox& to);
  ~event_follower();

  event_follower(const event_follower&) = delete;
  event_follower& operator=(const event_follower&) = delete;

private:
  void run();

  /// Tells what is kept, then each event, until they end. Throws why.
  void follow_once();

  std::vector<event> kept_events() const;

  /// Waits for the next attempt; false: there is to be none.
  bool pause();

  node_link node_;
  mailbox& to_;
  std::chrono::milliseconds next_pause_;
  std::mutex mutex_;
  std::condition_variable ends_;
  bool ended_ = false;
  std::thread reader_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
