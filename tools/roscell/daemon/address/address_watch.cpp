#include "tools/roscell/daemon/address/address_watch.hpp"

#include "tools/roscell/exit_code.hpp"

#include <cerrno>
#include <cstring>
#include <string>

#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

namespace roscell::cli {

address_watch::address_watch()
    : fd_{socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK,
                 NETLINK_ROUTE)} {
  sockaddr_nl wanted{};
  wanted.nl_family = AF_NETLINK;
  wanted.nl_groups = RTMGRP_IPV4_IFADDR | RTMGRP_LINK;
  if (!fd_
      || bind(fd_.get(), reinterpret_cast<const sockaddr*>(&wanted),
              sizeof wanted)
             != 0)
    throw command_error{exit_refused,
                        std::string{"the addresses of this host cannot be "
                                    "watched: "}
                            + std::strerror(errno),
                        "let the node use sockets of the family AF_NETLINK"};
}

void address_watch::clear() {
  // Only that there is a message counts; the kernel drops the rest of it. Where
  // it had no room for all of them it says so once, instead of a message.
  char first = 0;
  while (recv(fd_.get(), &first, sizeof first, 0) >= 0 || errno == ENOBUFS
         || errno == EINTR) {
  }
}

} // namespace roscell::cli
