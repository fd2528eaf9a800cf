#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/reach/reach_packet.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace roscell {

struct reach_port_options {
  std::string address;    ///< Of the interface by which multicast comes.
  unsigned domain_id = 0; ///< Whose ports one is taken of.
  digest key{};
};

/// The group by which DDS finds participants (RTPS 2.3, 9.6.1.4.1).
constexpr const char* discovery_group = "239.255.0.1";

/// A UDP port among those of DDS's data that answers what other nodes ask to
/// find out whether they reach this one, by multicast too.
class reach_port {
public:
  /// Errors: `conflict` if no port is free.
  static edge_result<std::unique_ptr<reach_port>>
  open(io_thread& io, const reach_port_options& options);

  /// Closes the port.
  virtual ~reach_port() = default;

  virtual uint16_t port() const = 0;
};

} // namespace roscell
