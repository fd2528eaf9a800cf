#include "actors/edge/host/interfaces.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <netpacket/packet.h>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/if_ether.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <tuple>

namespace roscell {

namespace {

using ifaddrs_list = std::unique_ptr<ifaddrs, void (*)(ifaddrs*)>;

ifaddrs_list read_ifaddrs() {
  ifaddrs* head = nullptr;
  if (getifaddrs(&head) != 0)
    head = nullptr;
  return {head, &freeifaddrs};
}

/// Empty when the interface has no MAC, or only zeros as loopback has.
std::string mac_text(const sockaddr_ll& link) {
  constexpr const char* digits = "0123456789abcdef";
  std::string result;
  bool any = false;
  for (int i = 0; i < 6 && link.sll_halen == 6; ++i) {
    result.push_back(digits[link.sll_addr[i] >> 4]);
    result.push_back(digits[link.sll_addr[i] & 15]);
    any = any || link.sll_addr[i] != 0;
  }
  return any ? result : std::string{};
}

/// The MACs by interface name, of interfaces without an IPv4 address too.
std::map<std::string, std::string> macs_of(const ifaddrs* head) {
  std::map<std::string, std::string> result;
  for (auto* i = head; i != nullptr; i = i->ifa_next)
    if (i->ifa_addr != nullptr && i->ifa_addr->sa_family == AF_PACKET)
      result[i->ifa_name] =
          mac_text(*reinterpret_cast<const sockaddr_ll*>(i->ifa_addr));
  return result;
}

bool is_hardware(const std::string& name) {
  std::error_code ec;
  return std::filesystem::exists("/sys/class/net/" + name + "/device", ec);
}

auto rank(const interface_address& x) {
  return std::make_tuple(x.loopback, !x.hardware, std::cref(x.name));
}

interface_address link_only(const std::string& name, const std::string& mac) {
  interface_address result;
  result.name = name;
  result.mac = mac;
  result.hardware = is_hardware(name);
  return result;
}

std::string usable_name(std::string_view hostname) {
  std::string result;
  for (unsigned char c : hostname.substr(0, 64))
    result.push_back(std::isalnum(c) != 0 || c == '-'
                         ? static_cast<char>(std::tolower(c))
                         : '-');
  return result.empty() ? "unnamed" : result;
}

} // namespace

void order_interfaces(std::vector<interface_address>& all) {
  std::stable_sort(all.begin(), all.end(),
                   [](auto& x, auto& y) { return rank(x) < rank(y); });
}

std::vector<interface_address> list_interfaces() {
  auto head = read_ifaddrs();
  auto macs = macs_of(head.get());
  std::vector<interface_address> result;
  for (auto* i = head.get(); i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != AF_INET
        || (i->ifa_flags & IFF_UP) == 0)
      continue;
    auto one = link_only(i->ifa_name, macs[i->ifa_name]);
    std::array<char, INET_ADDRSTRLEN> text{};
    auto* in = reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
    one.address = inet_ntop(AF_INET, &in->sin_addr, text.data(), text.size());
    one.loopback = (i->ifa_flags & IFF_LOOPBACK) != 0;
    one.carrier = (i->ifa_flags & IFF_RUNNING) != 0;
    result.push_back(std::move(one));
  }
  order_interfaces(result);
  return result;
}

std::vector<host_link> list_links() {
  const auto head = read_ifaddrs();
  std::map<std::string, host_link> result;
  for (auto* i = head.get(); i != nullptr; i = i->ifa_next)
    result[i->ifa_name] = {i->ifa_name, (i->ifa_flags & IFF_UP) != 0};
  std::vector<host_link> links;
  links.reserve(result.size());
  for (auto& [name, link] : result)
    links.push_back(std::move(link));
  return links;
}

std::string describe_interfaces(const std::vector<interface_address>& all) {
  std::string result;
  for (auto& x : all)
    result.append(result.empty() ? "" : ", ").append(x.name + ' ' + x.address);
  return result.empty() ? "none" : result;
}

edge_result<interface_address>
resolve_interface(std::string_view text,
                  const std::vector<interface_address>& all) {
  for (auto& x : all)
    if (!text.empty() && (x.name == text || x.address == text))
      return x;
  return edge_error{error_code::unreachable,
                    "\"" + std::string{text.substr(0, 64)}
                        + "\" is neither an interface nor an IPv4 address of "
                          "this host",
                    "this host has: " + describe_interfaces(all)};
}

edge_result<interface_address> resolve_interface(std::string_view text) {
  return resolve_interface(text, list_interfaces());
}

std::string mac_node_name(std::string_view chosen,
                          const std::vector<interface_address>& all,
                          std::string_view hostname) {
  for (auto& x : all)
    if (!chosen.empty() && (x.name == chosen || x.address == chosen)
        && !x.mac.empty())
      return "node-" + x.mac;
  for (auto& x : all)
    if (!x.mac.empty())
      return "node-" + x.mac;
  return "node-" + usable_name(hostname);
}

std::string mac_node_name(std::string_view chosen) {
  auto all = list_interfaces();
  for (auto& [name, mac] : macs_of(read_ifaddrs().get()))
    if (std::none_of(all.begin(), all.end(),
                     [&name = name](auto& x) { return x.name == name; }))
      all.push_back(link_only(name, mac));
  order_interfaces(all);
  std::array<char, 256> hostname{};
  if (gethostname(hostname.data(), hostname.size() - 1) != 0)
    hostname[0] = '\0';
  return mac_node_name(chosen, all, hostname.data());
}

namespace {

/// False where it is no Ethernet.
bool read_mac(int fd, const std::string& interface, uint8_t* mac) {
  ifreq wanted{};
  interface.copy(wanted.ifr_name, IFNAMSIZ - 1);
  if (ioctl(fd, SIOCGIFHWADDR, &wanted) != 0
      || wanted.ifr_hwaddr.sa_family != ARPHRD_ETHER)
    return false;
  std::memcpy(mac, wanted.ifr_hwaddr.sa_data, ETH_ALEN);
  return true;
}

ether_arp announcement_of(const std::string& address, const uint8_t* mac) {
  ether_arp result{};
  result.arp_hrd = htons(ARPHRD_ETHER);
  result.arp_pro = htons(ETH_P_IP);
  result.arp_hln = ETH_ALEN;
  result.arp_pln = sizeof(in_addr);
  result.arp_op = htons(ARPOP_REQUEST);
  std::memcpy(result.arp_sha, mac, ETH_ALEN);
  // Who asks for its own address.
  inet_pton(AF_INET, address.c_str(), result.arp_spa);
  inet_pton(AF_INET, address.c_str(), result.arp_tpa);
  return result;
}

} // namespace

void claim_address(const std::string& address) {
  const auto all = list_interfaces();
  const auto own = std::find_if(all.begin(), all.end(), [&](auto& x) {
    return x.address == address && !x.loopback;
  });
  if (own == all.end())
    return;
  const unique_fd fd{
      socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  uint8_t mac[ETH_ALEN];
  if (!fd || !read_mac(fd.get(), own->name, mac))
    return;
  const auto said = announcement_of(address, mac);
  sockaddr_ll everybody{};
  everybody.sll_family = AF_PACKET;
  everybody.sll_protocol = htons(ETH_P_ARP);
  everybody.sll_ifindex = static_cast<int>(if_nametoindex(own->name.c_str()));
  everybody.sll_halen = ETH_ALEN;
  std::fill_n(everybody.sll_addr, ETH_ALEN, uint8_t{0xff});
  // An interface that is down sends nothing; the next attempt claims again.
  sendto(fd.get(), &said, sizeof said, 0,
         reinterpret_cast<const sockaddr*>(&everybody), sizeof everybody);
}

} // namespace roscell
