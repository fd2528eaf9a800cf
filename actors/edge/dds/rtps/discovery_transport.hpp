#pragma once

#include "actors/edge/dds/lives/discovery_guard.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstdint>
#include <memory>
#include <string>

/// INTERNAL to this folder.
namespace roscell {

struct discovery_transport_options {
  std::string address;                   ///< IPv4, of this host.
  std::uint32_t max_sent_bytes = 0;      ///< In one datagram.
  std::uint32_t max_heard_bytes = 0;     ///< Longer ones are dropped.
  std::uint32_t socket_buffer_bytes = 0; ///< Wanted; 0: the kernel's own.
  bool serves_programs = false; ///< Hears those of this host at 127.0.0.1.
  std::shared_ptr<discovery_guard> guard; ///< A server's; others have none.
};

/// UDP over IPv4 on one local address only, no shared memory. Fast DDS sends as
/// it always does. It hears on the DDS thread (dds_thread.hpp), and sees only
/// the datagrams that are safe for it (discovery_filter.hpp). A discovery
/// server's guard has a look at them, too (lives/discovery_guard.hpp).
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
discovery_transport(discovery_transport_options options);

} // namespace roscell
