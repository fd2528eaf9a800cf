#pragma once

#include "actors/edge/io/unique_fd.hpp"

namespace roscell::cli {

/// The kernel's word, over netlink, that an IPv4 address or an interface of
/// this host has come, gone or changed. It says that something has, not what:
/// whoever hears it looks anew, so that nothing is missed where words got lost.
class address_watch {
public:
  /// Throws command_error where there is no such socket.
  address_watch();

  /// Can be read once there is news.
  int fd() const {
    return fd_.get();
  }

  /// Takes the news; the next one makes the descriptor readable again.
  void clear();

private:
  unique_fd fd_;
};

} // namespace roscell::cli
