#pragma once

#include "skills/ros2/flow/pace.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstdint>
#include <functional>
#include <memory>

/// INTERNAL to this folder.
namespace roscell::ros2 {

using transport_ptr =
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>;

/// Called for each port on which messages to this host alone are heard. It
/// must live as long as what the transport belongs to.
using port_handler = std::function<void(std::uint32_t port)>;

/// Lets the pacer decide when each datagram leaves by `lower`, and tells of the
/// ports that `lower` has opened: Fast DDS goes on without one where it finds
/// none that is free.
transport_ptr paced(transport_ptr lower, std::shared_ptr<datagram_pacer> pacer,
                    port_handler on_listening);

} // namespace roscell::ros2
