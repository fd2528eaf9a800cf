#pragma once

#include "actors/edge/dds/lives/discovery_guard.hpp"
#include "dds/host_transport.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstdint>
#include <memory>
#include <string>

/// INTERNAL to this folder.
namespace roscell {

/// UDP over IPv4 on one local address only, no shared memory.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
udp_transport(const host_transport_options& options);

/// Puts a guard over a UDP transport: Fast DDS only sees the datagrams that are
/// safe for it (discovery_filter.hpp). A discovery server's `guard` has a look
/// at them, too (lives/discovery_guard.hpp); others have none: null.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
guarded(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
            lower,
        std::shared_ptr<discovery_guard> guard);

} // namespace roscell
