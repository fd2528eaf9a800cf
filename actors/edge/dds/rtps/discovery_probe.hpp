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

} // namespace roscell
