#pragma once

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/site_token.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
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

struct reach_port_options {
  std::string address;    ///< Of the interface by which multicast comes.
  unsigned domain_id = 0; ///< Whose ports they are of.
  site_secret site;       ///< Of those who are answered.
};

/// The group by which DDS finds participants (RTPS 2.3, 9.6.1.4.1).
constexpr const char* discovery_group = "239.255.0.1";

/// The port between those of a host's first skills. It answers, too, unless
/// another program has it.
uint16_t first_data_port(unsigned domain_id);

/// The same for the domain of a data port; 0: it is of none.
uint16_t first_data_port_beside(uint16_t data_port);

/// UDP ports among those of DDS's data that answer what other nodes ask to find
/// out whether they reach this one, by multicast too: one where the first
/// skills of a host listen, between theirs, and one where its next skill will.
class reach_port {
public:
  /// Errors: `conflict` if no port is free.
  static edge_result<std::unique_ptr<reach_port>>
  open(io_thread& io, const reach_port_options& options);

  /// Closes the ports.
  virtual ~reach_port() = default;

  /// The last of them.
  virtual uint16_t port() const = 0;
};

} // namespace roscell
