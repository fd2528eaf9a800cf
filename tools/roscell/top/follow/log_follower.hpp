#pragma once

#include "tools/roscell/top/follow/mailbox.hpp"
#include "tools/roscell/top/follow/node_link.hpp"

#include <string>
#include <thread>

namespace roscell::cli::top {

/// Follows the log of one instance on a thread of its own: its last lines, then
/// each as it is written. Why it ends is a last line.
class log_follower {
public:
  log_follower(const http_endpoint& node, std::string instance, mailbox& to);
  ~log_follower();

  log_follower(const log_follower&) = delete;
  log_follower& operator=(const log_follower&) = delete;

  const std::string& instance() const {
    return instance_;
  }

private:
  void run();

  node_link node_;
  std::string instance_;
  mailbox& to_;
  std::thread reader_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
