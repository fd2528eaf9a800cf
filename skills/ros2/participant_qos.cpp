#include "skills/ros2/participant_qos.hpp"

#include "dds/host_transport.hpp"
#include "dds/server_addresses.hpp"
#include "roscell/skill/errors.hpp"

#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace roscell::ros2 {

namespace {

using namespace eprosima::fastdds;
using eprosima::fastrtps::rtps::DiscoveryProtocol_t;

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

/// An end that dies without farewell is forgotten after the lease. A discovery
/// server that has begun anew learns of this end by its next announcement,
/// which goes no further than this host.
constexpr std::int32_t lease_s = 30;
constexpr std::int32_t announcement_period_s = 4;

/// How often a client repeats itself until the server has answered. The time
/// to find another end is about three times this.
constexpr std::int32_t repeat_period_ns = 50'000'000;

/// Where we start to look for a free port, counted as ROS 2 counts them on one
/// host (RTPS 2.3, 9.6.1.1). The first places are left to ROS 2 nodes that find
/// each other by port.
constexpr std::uint32_t first_place = 40;
constexpr unsigned places = 100;

/// The host's transport listens on 127.0.0.1, too, so that stock programs
/// beside us reach us.
std::uint16_t listening_port(std::uint32_t domain, const std::string& address) {
  const auto first =
      static_cast<std::uint16_t>(7400 + 250 * domain + 10 + 2 * first_place);
  const auto found = free_port({address, "127.0.0.1"}, first, places);
  if (const auto* why = std::get_if<std::error_code>(&found))
    throw engine::start_error("no UDP port of " + address
                              + " can be listened on: " + why->message()
                              + "; `ss -uap` shows who has the ports");
  return std::get<std::uint16_t>(found);
}

void use_servers(dds::WireProtocolConfigQos& wire,
                 const participant_config& config, const std::string& address) {
  auto& discovery = wire.builtin.discovery_config;
  discovery.discoveryProtocol = DiscoveryProtocol_t::CLIENT;
  discovery.discoveryServer_client_syncperiod = {0, repeat_period_ns};
  for (const auto& server : config.servers) {
    rtps::RemoteServerAttributes remote;
    const auto prefix = server_prefix(server.id);
    std::copy(prefix.begin(), prefix.end(), remote.guidPrefix.value);
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
  const auto at =
      udp_locator(address, listening_port(config.domain_id, address));
  wire.builtin.metatrafficUnicastLocatorList.push_back(at);
  wire.default_unicast_locator_list.push_back(at);
}

/// For simple discovery, which uses multicast on every interface.
std::shared_ptr<rtps::UDPv4TransportDescriptor> udp_everywhere() {
  auto result = std::make_shared<rtps::UDPv4TransportDescriptor>();
  result->maxMessageSize = max_datagram_bytes;
  result->sendBufferSize = socket_buffer_bytes;
  result->receiveBufferSize = socket_buffer_bytes;
  return result;
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

dds::DomainParticipantQos
to_participant_qos(const participant_config& config,
                   std::shared_ptr<datagram_pacer> pacer,
                   port_handler on_listening) {
  dds::DomainParticipantQos result;
  result.name(config.node_name);
  constexpr std::string_view enclave = "enclave=/;";
  result.user_data().data_vec({enclave.begin(), enclave.end()});
  result.transport().use_builtin_transports = false;
  auto& wire = result.wire_protocol();
  wire.builtin.discovery_config.leaseDuration = {lease_s, 0};
  wire.builtin.discovery_config.leaseDuration_announcementperiod = {
      announcement_period_s, 0};
  if (config.servers.empty()) {
    result.transport().user_transports = {
        paced(udp_everywhere(), std::move(pacer), std::move(on_listening))};
  } else {
    auto address = local_address_towards(config.servers.front());
    result.transport().user_transports = {paced(
        host_transport({address, max_datagram_bytes, socket_buffer_bytes}),
        std::move(pacer), std::move(on_listening))};
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

namespace dds = eprosima::fastdds::dds;

std::string matched_text(const std::string& topic, const std::string& peer,
                         int count, int change) {
  return "'" + topic + "': a " + peer + (change < 0 ? " has left" : " has come")
         + "; now " + std::to_string(count);
}

std::string incompatible_text(const std::string& topic, const std::string& peer,
                              dds::QosPolicyId_t policy) {
  auto start = "'" + topic + "': a " + peer + " is left out, because ";
  switch (policy) {
  case dds::RELIABILITY_QOS_POLICY_ID:
    return start
           + "one end wants what the other does not offer; set parameter "
             "'ros2_reliability' to 'best_effort' where it is read";
  case dds::DURABILITY_QOS_POLICY_ID:
    return start
           + "one end wants what the other does not offer; set parameter "
             "'ros2_durability' to 'volatile' where it is read";
  default:
    return start + "the two differ in QoS policy " + std::to_string(policy);
  }
}

} // namespace roscell::ros2
