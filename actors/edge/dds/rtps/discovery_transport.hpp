#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

/// INTERNAL to this folder.
namespace roscell {

/// UDP over IPv4 on one local address only, no shared memory. Datagrams of up
/// to `max_message_bytes` are sent and received. Fast DDS only sees those that
/// are safe for it (discovery_filter.hpp).
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
guarded_udp_transport(const std::string& address,
                      std::uint32_t max_message_bytes);

} // namespace roscell
