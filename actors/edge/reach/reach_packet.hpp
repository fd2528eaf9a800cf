#pragma once

#include "actors/edge/io/crypto.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace roscell {

/// A datagram by which a node finds out whether it reaches another one:
/// "ROSCELL" and '?' or '!' (8 bytes), a nonce (16), truncated HMAC-SHA256 of
/// these (8). A question may be longer; its answer never is, so that nobody can
/// make a node send more than was sent to it.
constexpr std::size_t reach_packet_size = 32;

using reach_bytes = std::array<char, reach_packet_size>;
using reach_nonce = std::array<char, 16>;

/// What those who know the site token sign with.
digest reach_key(std::string_view site_token);

/// From the system's generator.
reach_nonce make_reach_nonce();

/// @param size at least `reach_packet_size`; zeros follow.
std::vector<std::uint8_t> reach_question(const reach_nonce& nonce,
                                         const digest& key, std::size_t size);

/// The answer to a datagram that is a question of somebody who has that site
/// token; under an empty one there is none.
std::optional<reach_bytes> reach_answer(std::string_view datagram,
                                        std::string_view site_token);

bool is_reach_answer(std::string_view datagram, const reach_nonce& nonce,
                     const digest& key);

} // namespace roscell
