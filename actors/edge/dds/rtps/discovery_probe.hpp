#pragma once

#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <netinet/in.h>

namespace roscell {

/// "44.53.03.5f.…"
std::string to_text(const guid_prefix& prefix);

/// A random prefix that names our vendor's DDS, for one question.
guid_prefix make_probe_prefix();

/// The participant name of every probe. Servers of ours do not greet it.
constexpr const char* probe_name = "roscell-probe";

/// A CLIENT of Fast DDS must name its server's GUID prefix, but who joins a
/// cell knows an address only. So we ask the address first, with one RTPS
/// datagram that introduces a client of `probe_lease_seconds`: the server
/// answers at `reply_to` within the round-trip time, and the header of
/// whatever it sends carries its prefix. (RTPS 2.3, 8.3.7.2 and 9.6.2.2.)
std::vector<std::uint8_t> probe_question(const guid_prefix& self,
                                         const sockaddr_in& reply_to);

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

/// Whether a server tells a participant's data in it, its own if it is asked by
/// a probe: more than that it lives.
bool is_introduction(std::uint8_t* datagram, std::size_t size);

/// So long a server remembers a probe whose farewell got lost.
constexpr std::uint32_t probe_lease_seconds = 5;

} // namespace roscell
