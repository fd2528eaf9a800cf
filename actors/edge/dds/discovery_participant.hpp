#pragma once

#include "actors/edge/dds/limits.hpp"
#include "actors/edge/dds/lives/discovery_guard.hpp"
#include "actors/edge/dds/ros_graph.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "dds/host_transport.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <fastdds/rtps/attributes/RTPSParticipantAttributes.h>
#include <fastdds/rtps/participant/RTPSParticipantListener.h>

/// INTERNAL to this folder: what servers, clients and the public participant
/// have in common. We use Fast DDS's RTPS layer, not its DDS layer:
/// discovery is all that we want of it.
namespace roscell {

/// ROS 2 allows the domains 0 to 232; beyond, Fast DDS calls `exit`.
constexpr std::uint32_t max_domain_id = 232;

struct participant_settings {
  std::string address; ///< The one local IPv4 address that it uses.
  std::string announcement;
  std::chrono::seconds lease = limits::discovery::lease;
  /// Half of a lease would do; a third lets one announcement get lost.
  std::chrono::seconds announcement_period =
      limits::discovery::announcement_period;
  /// The most bytes in one datagram that it sends: Fast DDS keeps seven buffers
  /// of this size.
  std::uint32_t max_sent_bytes = 4096;
  /// In one that it hears.
  std::uint32_t max_heard_bytes = 16384;
  /// Programs of others are its clients: it hears those of this host at
  /// 127.0.0.1, too, and answers what they ask about liveliness.
  bool serves_programs = false;
  std::shared_ptr<discovery_guard> guard; ///< A server's; others have none.
};

/// `schema_violation` when it is over `limits::discovery::announcement_bytes`.
std::optional<edge_error> check_announcement(const std::string& bytes);

/// `schema_violation` for a domain, periods or an announcement out of bounds.
std::optional<edge_error> check_settings(std::uint32_t domain_id,
                                         const participant_settings& settings);

/// Attributes with everything set that does not depend on the kind of
/// participant. Its discovery and user traffic share `port`.
eprosima::fastrtps::rtps::RTPSParticipantAttributes
make_attributes(const participant_settings& settings, std::uint16_t port);

/// Owns one RTPS participant.
class rtps_participant final
    : eprosima::fastrtps::rtps::RTPSParticipantListener {
public:
  /// Null when Fast DDS refuses, which it explains in its log only.
  /// `attributes` get a participant id of our own making. `graph` is told of
  /// the endpoints that it hears of.
  static std::unique_ptr<rtps_participant>
  create(std::uint32_t domain_id,
         eprosima::fastrtps::rtps::RTPSParticipantAttributes attributes,
         on_sighting callback, std::shared_ptr<ros_graph> graph = nullptr);

  /// Says farewell to the others. The callback is not called any more once
  /// this has begun; not to be called by the callback.
  ~rtps_participant() override;

  rtps_participant(const rtps_participant&) = delete;
  rtps_participant& operator=(const rtps_participant&) = delete;

  /// Replaces the USER_DATA, and sends it to all who know us.
  void update_announcement(const std::string& bytes);

  /// Sends the own data to all who know us.
  void announce();

  /// The UDP port on which it takes discovery data: the one asked for, or the
  /// next that was free.
  std::uint16_t port() const;

private:
  rtps_participant(on_sighting callback, std::shared_ptr<ros_graph> graph);

  void onParticipantDiscovery(
      eprosima::fastrtps::rtps::RTPSParticipant*,
      eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;

  void
  onReaderDiscovery(eprosima::fastrtps::rtps::RTPSParticipant*,
                    eprosima::fastrtps::rtps::ReaderDiscoveryInfo&&) override;

  void
  onWriterDiscovery(eprosima::fastrtps::rtps::RTPSParticipant*,
                    eprosima::fastrtps::rtps::WriterDiscoveryInfo&&) override;

  std::mutex mutex_; // Held while the callback runs.
  on_sighting callback_;
  const std::shared_ptr<ros_graph> graph_;
  eprosima::fastrtps::rtps::RTPSParticipant* participant_ = nullptr;
};

} // namespace roscell
