#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/reach/reach_packet.hpp"
#include "actors/edge/site/site_secret.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace roscell {

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
