#pragma once

#include <string>

namespace roscell {

/// Tells the hosts of the subnet which of them has this IPv4 address, one of
/// this host, so that whoever has sent its packets to another host sends them
/// here again: after a host that had the same address has gone, others would go
/// on for up to a minute. One packet, an ARP announcement as of RFC 5227, to
/// the interface that has the address. Without the right to send it
/// (CAP_NET_RAW), and where the interface knows no ARP, nothing happens.
void claim_address(const std::string& address);

} // namespace roscell
