#pragma once

#include "dds/server_addresses.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

struct participant_news {
  guid_prefix who{};
  bool ended = false; ///< It is told that it is not there any more.
};

/// The sender of an RTPS message.
guid_prefix sender_of(const std::uint8_t* message);

/// The participants whom a message that is safe (discovery_filter.cpp) tells
/// of.
std::vector<participant_news> participants_in(std::uint8_t* message,
                                              std::size_t size);

/// Whom a message that is sound introduces its sender to; none if it tells of
/// anything else, but for a HEARTBEAT.
std::optional<guid_prefix> introduced_to(std::uint8_t* message,
                                         std::size_t size);

/// Whether its sender tells that it is there.
bool introduces_itself(std::uint8_t* message, std::size_t size);

/// What a participant tells of itself.
struct own_announcement {
  std::string name;         ///< Of the participant; may be empty.
  std::string announcement; ///< Its USER_DATA; may be empty.
};

/// The first thing that the sender of a message tells of itself in it, none if
/// that is nothing. Any bytes will do.
std::optional<own_announcement> own_announcement_in(std::uint8_t* message,
                                                    std::size_t size);

/// Raises the numbers of what the sender tells of itself, but not of its end.
void raise_own_news(std::uint8_t* message, std::size_t size, std::int64_t by);

/// Whether the participant `to` is not to be told anything of `who`.
using unwanted_news =
    std::function<bool(const guid_prefix& to, const guid_prefix& who)>;

/// Takes out what a message of this server says of participants, and of their
/// readers and writers, to somebody who is not to be told: its numbers are
/// skipped by a GAP instead, so that nobody asks for them again. What ends is
/// told whatever it is.
void leave_out(std::uint8_t* message, std::size_t size,
               const unwanted_news& is_unwanted);

} // namespace roscell
