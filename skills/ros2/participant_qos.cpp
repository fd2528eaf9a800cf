#include "skills/ros2/participant_qos.hpp"

#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <random>
#include <string_view>

namespace roscell::ros2 {

namespace {

using namespace eprosima::fastdds;
using eprosima::fastrtps::rtps::DiscoveryProtocol_t;
using eprosima::fastrtps::rtps::Locator_t;

/// The most that Fast DDS puts into one datagram.
constexpr std::uint32_t max_datagram_bytes = 65500;

/// Room for a whole image. Linux gives what net.core.rmem_max allows.
constexpr std::uint32_t socket_buffer_bytes = 8 * 1024 * 1024;

/// Large messages leave at 196 MB/s: an image of 1280x960 in colour within 19
/// ms, while what a period brings still fits into the socket buffer of a
/// receiver that has the 208 KiB of a Linux that nobody tuned.
constexpr const char* pace_name = "roscell_large_messages";
constexpr std::int32_t pace_bytes = 3 * max_datagram_bytes;
constexpr std::uint64_t pace_period_ms = 1;

/// A receiver that lost a part of a large message learns of it by the next
/// heartbeat.
constexpr std::int32_t large_heartbeat_ns = 100'000'000;

/// An end that dies without farewell is forgotten after the lease; half of the
/// idle traffic of ROS 2's 20 s and 3 s is worth that.
constexpr std::int32_t lease_s = 30;
constexpr std::int32_t announcement_period_s = 10;

/// How often a client repeats itself until the server has answered. The time
/// to find another end is about three times this.
constexpr std::int32_t repeat_period_ns = 100'000'000;

/// Where we start to look for a free port, counted as ROS 2 counts them on one
/// host (RTPS 2.3, 9.6.1.1). The first places are left to ROS 2 nodes that find
/// each other by port.
constexpr std::uint32_t first_place = 40;

Locator_t udp_locator(const std::string& address, std::uint32_t port) {
  Locator_t result;
  eprosima::fastrtps::rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4,
                                                     address, port, result);
  return result;
}

/// The prefix that ROS 2 expects of server `id`, in hexadecimal digits
/// 44.53.ID.5f.45.50.52.4f.53.49.4d.41: "DS", the id, and "_EPROSIMA".
void set_server_prefix(eprosima::fastrtps::rtps::GuidPrefix_t& prefix,
                       std::uint8_t id) {
  std::copy_n("DS\0_EPROSIMA", sizeof(prefix.value), prefix.value);
  prefix.value[2] = id;
}

/// Fast DDS makes the GUID of a participant of the process id and 16 random
/// bits, and processes in containers have the same few process ids.
std::int32_t make_participant_id() {
  constexpr std::int32_t lowest = 1000; // Above those that Fast DDS hands out.
  constexpr std::int32_t highest = 25000;
  std::random_device source;
  return std::uniform_int_distribution<std::int32_t>{lowest, highest}(source);
}

void use_servers(dds::WireProtocolConfigQos& wire,
                 const participant_config& config, const std::string& address) {
  auto& discovery = wire.builtin.discovery_config;
  discovery.discoveryProtocol = DiscoveryProtocol_t::CLIENT;
  discovery.discoveryServer_client_syncperiod = {0, repeat_period_ns};
  for (const auto& server : config.servers) {
    rtps::RemoteServerAttributes remote;
    set_server_prefix(remote.guidPrefix, server.id);
    remote.metatrafficUnicastLocatorList.push_back(
        udp_locator(server.address, server.port));
    discovery.m_DiscoveryServers.push_back(remote);
  }
  wire.participant_id = make_participant_id();
  // Fast DDS checks the ports that it would derive from domain and id.
  wire.port.domainIDGain = 0;
  // With addresses of our own Fast DDS opens no multicast ones. Discovery and
  // messages share a port, so that a writer's farewell does not overtake its
  // last message.
  auto at = udp_locator(address,
                        7400 + 250 * config.domain_id + 10 + 2 * first_place);
  wire.builtin.metatrafficUnicastLocatorList.push_back(at);
  wire.default_unicast_locator_list.push_back(at);
}

/// What readers and writers have in common.
template <class Qos>
void apply(const topic_qos& qos, Qos& to) {
  to.reliability().kind = qos.reliable ? dds::RELIABLE_RELIABILITY_QOS
                                       : dds::BEST_EFFORT_RELIABILITY_QOS;
  to.durability().kind = qos.transient_local
                             ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                             : dds::VOLATILE_DURABILITY_QOS;
  to.history().depth = qos.depth;
  to.resource_limits().allocated_samples = 1;
  // Memory is taken as messages need it, and used again.
  to.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  to.data_sharing().off();
}

} // namespace

dds::DomainParticipantQos to_participant_qos(const participant_config& config) {
  dds::DomainParticipantQos result;
  result.name(config.node_name);
  constexpr std::string_view enclave = "enclave=/;";
  result.user_data().data_vec({enclave.begin(), enclave.end()});
  auto udp = std::make_shared<rtps::UDPv4TransportDescriptor>();
  udp->maxMessageSize = max_datagram_bytes;
  udp->sendBufferSize = socket_buffer_bytes;
  udp->receiveBufferSize = socket_buffer_bytes;
  result.transport().use_builtin_transports = false;
  result.transport().user_transports.push_back(udp);
  auto& wire = result.wire_protocol();
  wire.builtin.use_WriterLivelinessProtocol = false;
  wire.builtin.discovery_config.leaseDuration = {lease_s, 0};
  wire.builtin.discovery_config.leaseDuration_announcementperiod = {
      announcement_period_s, 0};
  if (!config.servers.empty()) {
    auto address = local_address_towards(config.servers.front());
    udp->interfaceWhiteList = {address};
    use_servers(wire, config, address);
  }
  auto pace = std::make_shared<rtps::FlowControllerDescriptor>();
  pace->name = pace_name;
  pace->max_bytes_per_period = pace_bytes;
  pace->period_ms = pace_period_ms;
  result.flow_controllers().push_back(pace);
  return result;
}

dds::DataReaderQos to_reader_qos(const topic_qos& qos) {
  dds::DataReaderQos result;
  apply(qos, result);
  return result;
}

dds::DataWriterQos to_writer_qos(const topic_qos& qos) {
  dds::DataWriterQos result;
  apply(qos, result);
  if (qos.large) {
    result.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
    result.publish_mode().flow_controller_name = pace_name;
    result.reliable_writer_qos().times.heartbeatPeriod = {0,
                                                          large_heartbeat_ns};
  }
  return result;
}

} // namespace roscell::ros2
