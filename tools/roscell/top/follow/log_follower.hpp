#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/top/follow/mailbox.hpp"

#include <functional>
#include <string>
#include <thread>

namespace roscell::cli::top {

/// Follows the log of one instance on a thread of its own: its last lines, then
/// each as it is written. Why it ends is a last line.
class log_follower {
public:
  /// Called by who works off the mailbox.
  using line_taker = std::function<void(const std::string& line)>;

  log_follower(const node_client& node, std::string instance, mailbox& to,
               line_taker take);
  ~log_follower();

  log_follower(const log_follower&) = delete;
  log_follower& operator=(const log_follower&) = delete;

  const std::string& instance() const {
    return instance_;
  }

private:
  void run();
  void put(const std::string& line);

  const node_client& node_;
  http_cancel cancel_;
  std::string instance_;
  mailbox& to_;
  line_taker take_;
  std::thread reader_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
