#include "actors/edge/host/address_claim.hpp"

#include "actors/edge/host/interfaces.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <algorithm>
#include <cstring>

#include <arpa/inet.h>
#include <net/if.h>
#include <net/if_arp.h>
#include <netinet/if_ether.h>
#include <netpacket/packet.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace roscell {

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
