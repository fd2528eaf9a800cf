#include "tools/roscell/daemon/node_address.hpp"

#include "tools/roscell/exit_code.hpp"

#include <arpa/inet.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <iostream>
#include <string>
#include <utility>

namespace roscell::cli {

using namespace std::chrono_literals;

address_tracker::address_tracker(interface_address at, bool fixed)
    : at_{std::move(at)}, fixed_{fixed}, unreliable_{!at_.carrier} {}

/// Its own address before all others of the interface, which may have got a
/// further one.
const interface_address*
address_tracker::find(const std::vector<interface_address>& all) const {
  const interface_address* result = nullptr;
  for (const auto& x : all) {
    if (x.address == at_.address && (fixed_ || x.name == at_.name))
      return &x;
    if (!result && !fixed_ && x.name == at_.name)
      result = &x;
  }
  return result;
}

void address_tracker::observe(const std::vector<interface_address>& all,
                              time_point now) {
  const auto* found = find(all);
  const bool is_here = found && found->address == at_.address;
  if (!is_here && !gone_since_)
    gone_since_ = now;
  if (is_here && gone_since_) {
    unreliable_ = unreliable_ || now - *gone_since_ >= tolerated_gap;
    gone_since_.reset();
  }
  const bool replaces = found && found->carrier && (!is_here || unreliable_);
  const auto successor = replaces ? found->address : std::string{};
  if (std::exchange(successor_, successor) != successor)
    successor_since_ = now;
}

address_tracker::time_point address_tracker::settled_at() const {
  const bool first_carrier = !at_.carrier && successor_ == at_.address;
  return successor_since_ + (first_carrier ? 0ms : settling);
}

address_action address_tracker::action(time_point now) const {
  if (!successor_.empty() && now >= settled_at())
    return address_action::renew;
  if (fixed_ && gone_since_ && now - *gone_since_ >= patience)
    return address_action::give_up;
  return address_action::stay;
}

std::optional<address_tracker::time_point> address_tracker::due() const {
  if (!successor_.empty())
    return settled_at();
  if (fixed_ && gone_since_)
    return *gone_since_ + patience;
  return std::nullopt;
}

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

namespace {

/// The number in `text`, from 1 to `most`; 0 if it is none.
size_t parse_choice(const std::string& text, size_t most) {
  size_t choice = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, choice);
  return error == std::errc{} && rest == end && choice <= most ? choice : 0;
}

/// Linux takes no other names, and who says digits alone means an address; the
/// interface itself may come later.
bool may_be_name(const std::string& text) {
  return text.size() < IFNAMSIZ
         && text.find_first_not_of("0123456789.") != std::string::npos
         && std::none_of(text.begin(), text.end(), [](unsigned char c) {
              return c == '/' || c == ':' || std::isspace(c) != 0;
            });
}

} // namespace

interface_address ask_for_interface(const std::vector<interface_address>& all,
                                    std::istream& answers, std::ostream& out) {
  out << "Which network interface connects this node to its cell?\n";
  for (size_t i = 0; i < all.size(); ++i)
    out << "  " << i + 1 << "  " << all[i].name << "  " << all[i].address
        << (all[i].loopback ? "  (this machine only)" : "") << "\n";
  std::string line;
  while (out << "Number: " << std::flush && std::getline(answers, line)) {
    if (const auto choice = parse_choice(line, all.size()); choice != 0)
      return all[choice - 1];
    out << "Please type a number from 1 to " << all.size() << ".\n";
  }
  throw command_error{exit_usage, "no interface was chosen",
                      "use --interface; there are " + describe_interfaces(all)};
}

std::string choose_interface(const std::string& wanted) {
  if (!wanted.empty()) {
    if (!is_ipv4_address(wanted) && may_be_name(wanted))
      return wanted;
    const auto found = resolve_interface(wanted);
    if (const auto* why = std::get_if<edge_error>(&found))
      throw command_error{exit_usage, "--interface: " + why->message,
                          why->hint};
    return wanted;
  }
  const auto all = list_interfaces();
  if (isatty(STDIN_FILENO) == 1 && !all.empty())
    return ask_for_interface(all, std::cin, std::cerr).name;
  throw command_error{exit_usage, "--interface is missing",
                      "there are " + describe_interfaces(all)};
}

std::string describe_links(const std::vector<interface_address>& all,
                           const std::vector<host_link>& links) {
  std::vector<interface_address> named = all;
  for (const auto& link : links)
    if (std::none_of(all.begin(), all.end(),
                     [&](const auto& x) { return x.name == link.name; })) {
      interface_address one;
      one.name = link.name;
      one.address = link.up ? "(no IPv4 address)" : "(down)";
      named.push_back(one);
    }
  return describe_interfaces(named);
}

bool is_ipv4_address(const std::string& text) {
  in_addr ignored{};
  return inet_pton(AF_INET, text.c_str(), &ignored) == 1;
}

std::variant<interface_address, std::string>
find_interface(const std::string& wanted, bool with_carrier,
               const std::vector<interface_address>& all,
               const std::vector<host_link>& links) {
  const auto found = resolve_interface(wanted, all);
  if (const auto* at = std::get_if<interface_address>(&found)) {
    if (at->carrier || !with_carrier)
      return *at;
    return "interface '" + at->name + "' (" + at->address
           + ") has no carrier: no cable is in, or no network is in reach";
  }
  const auto link = std::find_if(links.begin(), links.end(),
                                 [&](auto& x) { return x.name == wanted; });
  if (link == links.end())
    return "'" + wanted + "' is not there";
  return "interface '" + wanted
         + (link->up ? "' has no IPv4 address, and IPv6 is not used"
                     : "' is down");
}

} // namespace roscell::cli
