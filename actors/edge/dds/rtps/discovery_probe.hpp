#pragma once

#include "dds/server_addresses.hpp"

#include <netinet/in.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// "44.53.03.5f.…"
std::string to_text(const guid_prefix& prefix);

/// A random prefix that names our vendor's DDS, for one question.
guid_prefix make_probe_prefix();

/// The participant name of every probe.
constexpr const char* probe_name = "roscell-probe";

/// Who joins a cell knows the address of a discovery server only, so it asks
/// that address, with one RTPS datagram that introduces a client of
/// `probe_lease_seconds`. A server of ours answers it at once with
/// `probe_reply`, and keeps nothing (probe_responder.hpp). Any other one, and
/// one of an earlier version, takes it for a client, and sends its own data at
/// `reply_to` within 110 ms. (RTPS 2.3, 8.3.7.2 and 9.6.2.2.)
std::vector<std::uint8_t> probe_question(const guid_prefix& self,
                                         const sockaddr_in& reply_to);

/// The own data of a discovery server, with its announcement.
std::vector<std::uint8_t> probe_reply(const guid_prefix& server,
                                      const std::string& announcement);

/// The prober's message `number`, from 2 on: a participant has ended. Of two
/// messages about it the one with the higher number of its sample counts, and
/// this has the lowest: who comes back after all is heard.
std::vector<std::uint8_t> death_notice(const guid_prefix& self,
                                       std::uint32_t number,
                                       const guid_prefix& dead);

/// Takes the introduction back.
std::vector<std::uint8_t> probe_farewell(const guid_prefix& self);

/// The sender of an RTPS datagram, none for anything else.
std::optional<guid_prefix> probe_answer(const std::uint8_t* datagram,
                                        std::size_t size);

/// So long a server remembers a probe whose farewell got lost.
constexpr std::uint32_t probe_lease_seconds = 5;

/// One thing that a participant of ours noticed about another participant.
struct sighting {
  enum class kind {
    appeared, ///< It was found.
    changed,  ///< Its announcement changed.
    left,     ///< It said that it goes.
    lost,     ///< It was silent for its lease.
  };

  kind what = kind::appeared;
  guid_prefix prefix{};
  std::string name;         ///< The participant's name, at most 255 bytes.
  std::string announcement; ///< Its USER_DATA, empty if over the limit.
};

/// What a discovery server says of itself to who asks.
struct server_sighting {
  std::uint8_t server_id = 0;
  guid_prefix prefix{};
  std::string announcement; ///< USER_DATA as it came, foreign bytes included.
};

/// Called on a thread of Fast DDS, one call at a time for one participant.
using on_sighting = std::function<void(const sighting&)>;

// INTERNAL to actors/edge/dds.

/// What a server of an earlier version wants to hear before it sends its own
/// data: the answer, number `count` of the prober, to a HEARTBEAT of its
/// participants' writer, which asks for all that it has. Empty: `datagram`
/// holds none that is for `self`.
std::vector<std::uint8_t> heartbeat_answer(const guid_prefix& self,
                                           std::uint32_t count,
                                           std::uint8_t* datagram,
                                           std::size_t size);

/// HEARTBEATs of all writers of a discovery server: nothing is written yet.
std::vector<std::uint8_t> first_heartbeats(const guid_prefix& server);

} // namespace roscell
