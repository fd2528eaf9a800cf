#pragma once

#include "dds/host_transport.hpp"

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

/// INTERNAL to this folder.
namespace roscell {

/// Holds back what would go to one address while nobody is there to hear it:
/// Fast DDS looks for a silent server ten times a second, for ever. Shut at
/// first. May be used by several threads.
class route_gate {
public:
  route_gate(const std::string& address, std::uint16_t port);

  void open(bool x) {
    open_ = x;
  }

  bool passes(const eprosima::fastrtps::rtps::Locator_t& to) const {
    return open_ || !(to == to_);
  }

private:
  const eprosima::fastrtps::rtps::Locator_t to_;
  std::atomic<bool> open_{false};
};

/// UDP over IPv4 on one local address only, no shared memory.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
udp_transport(const host_transport_options& options);

/// Puts a guard over a UDP transport: Fast DDS only sees the datagrams that are
/// safe for it (discovery_filter.hpp). `route` may be null.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
guarded(std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
            lower,
        std::shared_ptr<route_gate> route);

} // namespace roscell
