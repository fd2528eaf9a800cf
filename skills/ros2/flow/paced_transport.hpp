#pragma once

#include "skills/ros2/flow/pace.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <memory>

/// INTERNAL to this folder.
namespace roscell::ros2 {

using transport_ptr =
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>;

/// Lets the pacer decide when each datagram leaves by `lower`.
transport_ptr paced(transport_ptr lower, std::shared_ptr<datagram_pacer> pacer);

} // namespace roscell::ros2
