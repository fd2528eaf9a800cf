#pragma once

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstdint>
#include <memory>
#include <string>

namespace roscell {

/// A participant id above those that Fast DDS hands out. Fast DDS makes the
/// GUID of a participant of the process id and 16 random bits, and processes in
/// containers have the same few process ids; with an id of its own, one that
/// replaces another has another GUID, also when the farewell of the first got
/// lost. Fast DDS derives a port from the id, which must stay below 65536.
std::int32_t make_participant_id();

eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                std::uint32_t port);

struct host_transport_options {
  std::string address;                     ///< IPv4, of this host.
  std::uint32_t max_message_bytes = 65500; ///< Of one datagram.
  /// Wanted from the kernel, which gives what its own limits allow; 0: as it
  /// gives by itself.
  std::uint32_t socket_buffer_bytes = 0;
};

/// UDP over IPv4 on one address of this host and, on the same ports, on
/// 127.0.0.1. No shared memory, which does not reach into containers.
///
/// A stock ROS 2 program sends what goes to its own host to 127.0.0.1, whatever
/// address was announced (Fast DDS 2.9.1, `transform_remote_locator`), so who
/// listens on one address only is deaf to programs beside it. Datagrams leave
/// by one socket: with both addresses in Fast DDS's list of interfaces each
/// would leave twice.
///
/// Of the addresses that another participant announces, 127.0.0.1 is kept, and
/// those of this host other than `address` are left out, because programs of
/// this host announce `address` too, and those of another host have networks
/// of the same numbers. Where `address` is itself a loopback one, every address
/// of this host means 127.0.0.1.
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
host_transport(const host_transport_options& options);

} // namespace roscell
