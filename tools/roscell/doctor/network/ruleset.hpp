#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>

namespace roscell::cli {

/// A packet that begins something new and arrives from another host.
struct arriving_packet {
  std::string protocol;  ///< "tcp" or "udp".
  unsigned port = 0;     ///< That it goes to.
  std::string interface; ///< That it comes in by; empty: not known.
};

enum class packet_fate {
  accepted,
  dropped,
  depends, ///< On what no rule of the packet's own tells: its sender, its rate.
};

/// What becomes of a packet.
struct packet_verdict {
  packet_fate fate = packet_fate::accepted;
  std::string family; ///< Of the chain that decides, with table and name.
  std::string table;
  std::string chain;   ///< The one that the kernel begins with.
  std::string why;     ///< "the chain's policy", "its rule 7", ...
  bool by_ufw = false; ///< Its rules are written by ufw.
};

/// What nftables does with an arriving packet, by what `nft -j list ruleset`
/// says. Chains of the hooks `input` and `prerouting` are gone through, with
/// those that they jump to. A rule that asks for more than protocol, port,
/// interface and state of the connection leaves it open.
packet_verdict judge_packet(const json& ruleset, const arriving_packet& packet);

} // namespace roscell::cli
