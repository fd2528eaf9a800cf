#include "tools/roscell/doctor/network/addresses.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <variant>

namespace roscell::cli {

namespace {

/// RTPS 2.3, 9.6.1.4.1; and the discovery port of domain 0.
constexpr const char* discovery_group = "239.255.0.1";
constexpr uint16_t discovery_group_port = 7400;

constexpr int ethernet_mtu = 1500;

/// The largest datagrams that skills send, with their UDP header.
constexpr int largest_packet = 65500 + 8;
constexpr int ip_header = 20;

int fragments_at(int mtu) {
  const int part = mtu - ip_header;
  return (largest_packet + part - 1) / part;
}

finding no_address(const std::string& wanted,
                   const std::vector<interface_address>& all,
                   const link_readings& link) {
  constexpr auto why = "a node cannot start: all of its traffic goes through "
                       "one address of this host";
  if (link.exists && !link.up)
    return {judgement::broken, wanted + " is down", why,
            "sudo ip link set dev " + shell_word(wanted) + " up"};
  if (link.exists)
    return {judgement::broken, wanted + " has no IPv4 address", why,
            "sudo ip address add ADDRESS/24 dev " + shell_word(wanted)};
  if (all.empty())
    return {judgement::broken, "no interface is up and has an IPv4 address",
            why, "sudo ip link set dev lo up && ip -brief address"};
  return {judgement::broken,
          "'" + wanted + "' is no interface and no IPv4 address of this host, "
              + "which has " + describe_interfaces(all),
          why, "roscell node --interface " + shell_word(all.front().name)};
}

/// The finding of a check that has no interface to look at.
finding no_interface() {
  return {judgement::skipped, "no interface was found to check"};
}

} // namespace

link_readings read_link_state(const std::string& name) {
  link_readings result;
  const unique_fd fd{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  ifreq request{};
  if (!fd || name.empty() || name.size() >= sizeof(request.ifr_name))
    return result;
  name.copy(request.ifr_name, sizeof(request.ifr_name) - 1);
  if (ioctl(fd.get(), SIOCGIFFLAGS, &request) != 0)
    return result;
  const auto flags = static_cast<unsigned short>(request.ifr_flags);
  result.exists = true;
  result.up = (flags & IFF_UP) != 0;
  result.carrier = (flags & IFF_RUNNING) != 0;
  result.multicast = (flags & IFF_MULTICAST) != 0;
  if (ioctl(fd.get(), SIOCGIFMTU, &request) == 0)
    result.mtu = request.ifr_mtu;
  return result;
}

std::optional<interface_address>
checked_address(const std::string& wanted,
                const std::vector<interface_address>& all) {
  if (wanted.empty())
    return all.empty() ? std::nullopt : std::optional{all.front()};
  const auto found = resolve_interface(wanted, all);
  const auto* address = std::get_if<interface_address>(&found);
  return address == nullptr ? std::nullopt : std::optional{*address};
}

finding judge_interface(const std::string& wanted,
                        const std::vector<interface_address>& all,
                        const link_readings& link) {
  const auto at = checked_address(wanted, all);
  if (!at)
    return no_address(wanted, all, link);
  const auto seen = at->name + " has " + at->address;
  if (!link.carrier)
    return {judgement::broken, seen + ", but no carrier",
            "nothing leaves this host: no cable, no access point, or the other "
            "end is down",
            "sudo ip link set dev " + shell_word(at->name)
                + " down && sudo ip link set dev " + shell_word(at->name)
                + " up"};
  if (at->loopback && wanted.empty())
    return {judgement::warning, seen + ", and there is no other address",
            "only nodes of this host can be in its cell", "ip -brief address"};
  return {judgement::ok, seen};
}

finding judge_mtu(const interface_address& at, const link_readings& link) {
  const auto seen =
      at.name + " takes packets of " + std::to_string(link.mtu) + " bytes";
  if (link.mtu >= ethernet_mtu || link.mtu <= ip_header)
    return {judgement::ok, seen};
  return {judgement::warning, seen,
          "a datagram of an image becomes "
              + std::to_string(fragments_at(link.mtu))
              + " fragments instead of "
              + std::to_string(fragments_at(ethernet_mtu))
              + ", and the loss of one loses them all. A tunnel needs it so; "
                "elsewhere raise it",
          "sudo ip link set dev " + shell_word(at.name) + " mtu 1500"};
}

multicast_route read_multicast_route() {
  multicast_route result;
  const unique_fd fd{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(discovery_group_port);
  inet_pton(AF_INET, discovery_group, &to.sin_addr);
  // Nothing is sent: the kernel only looks up the way.
  if (!fd
      || connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to)
             != 0) {
    result.error = errno;
    return result;
  }
  sockaddr_in from{};
  socklen_t size = sizeof from;
  std::array<char, INET_ADDRSTRLEN> text{};
  if (getsockname(fd.get(), reinterpret_cast<sockaddr*>(&from), &size) == 0)
    result.address =
        inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size());
  return result;
}

finding judge_multicast(const interface_address& at, const link_readings& link,
                        const multicast_route& route) {
  if (at.loopback)
    return {judgement::skipped, at.name + " reaches this host only"};
  const auto add_route =
      "sudo ip route replace 239.255.0.1/32 dev " + shell_word(at.name);
  constexpr auto why = "nodes without --join or --peer, and ROS 2 programs "
                       "without `roscell env`, are not found by others";
  if (!link.multicast)
    return {judgement::warning, at.name + " takes no multicast", why,
            "sudo ip link set dev " + shell_word(at.name) + " multicast on"};
  if (route.error != 0)
    return {judgement::warning,
            std::string{"there is no route to 239.255.0.1: "}
                + std::strerror(route.error),
            why, add_route};
  if (!route.address.empty() && route.address != at.address)
    return {judgement::warning,
            "239.255.0.1 is sent from " + route.address + ", not by " + at.name,
            why, add_route};
  return {judgement::ok,
          at.name + " takes multicast, and 239.255.0.1 leaves by it"};
}

findings check_interface(const checked_host& host) {
  const auto all = list_interfaces();
  const auto at = checked_address(host.interface, all);
  return {judge_interface(host.interface, all,
                          read_link_state(at ? at->name : host.interface))};
}

findings check_mtu(const checked_host& host) {
  const auto at = checked_address(host.interface, list_interfaces());
  return {at ? judge_mtu(*at, read_link_state(at->name)) : no_interface()};
}

findings check_multicast(const checked_host& host) {
  const auto at = checked_address(host.interface, list_interfaces());
  return {at ? judge_multicast(*at, read_link_state(at->name),
                               read_multicast_route())
             : no_interface()};
}

} // namespace roscell::cli
