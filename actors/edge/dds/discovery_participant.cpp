#include "actors/edge/dds/discovery_participant.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/rtps/discovery_transport.hpp"
#include "actors/house/limits.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <random>
#include <sstream>
#include <utility>

namespace roscell {

namespace {

using namespace eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

Duration_t to_duration(std::chrono::seconds x) {
  return {static_cast<std::int32_t>(x.count()), 0};
}

/// With an id per participant, the GUID prefix of one that replaces another
/// differs, also when the farewell of the first got lost. Fast DDS derives a
/// port from the id, which must stay below 65536.
std::int32_t make_participant_id() {
  constexpr std::int32_t lowest = 1000; // Above those that Fast DDS hands out.
  constexpr std::int32_t highest = 25000;
  std::random_device source;
  return std::uniform_int_distribution<std::int32_t>{lowest, highest}(source);
}

/// Collections grow by one entry as needed, up to what a flood may cost us.
void keep_small(RTPSParticipantAllocationAttributes& allocation) {
  allocation.participants = {1, 4096, 1};
  allocation.readers = {1, 4096, 1};
  allocation.writers = {1, 4096, 1};
  allocation.send_buffers.preallocated_number = 1;
  allocation.send_buffers.dynamic = true;
}

sighting::kind to_kind(ParticipantDiscoveryInfo::DISCOVERY_STATUS status) {
  switch (status) {
  case ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT:
    return sighting::kind::appeared;
  case ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT:
    return sighting::kind::changed;
  case ParticipantDiscoveryInfo::REMOVED_PARTICIPANT:
    return sighting::kind::left;
  default:
    return sighting::kind::lost;
  }
}

sighting to_sighting(const ParticipantDiscoveryInfo& info) {
  sighting result;
  result.what = to_kind(info.status);
  std::copy_n(info.info.m_guid.guidPrefix.value, result.prefix.size(),
              result.prefix.begin());
  result.name = info.info.m_participantName.to_string();
  auto& data = info.info.m_userData;
  if (data.size() <= limits::discovery::announcement_bytes)
    result.announcement.assign(data.begin(), data.end());
  return result;
}

edge_error out_of_bounds(std::string message) {
  return {error_code::schema_violation, std::move(message), ""};
}

} // namespace

std::optional<edge_error> check_announcement(const std::string& bytes) {
  if (bytes.size() <= limits::discovery::announcement_bytes)
    return std::nullopt;
  return out_of_bounds("an announcement of " + std::to_string(bytes.size())
                       + " bytes is over the limit of "
                       + std::to_string(limits::discovery::announcement_bytes));
}

std::optional<edge_error> check_settings(std::uint32_t domain_id,
                                         const participant_settings& settings) {
  if (domain_id > max_domain_id)
    return out_of_bounds("ROS domain " + std::to_string(domain_id) + " is over "
                         + std::to_string(max_domain_id));
  if (settings.announcement_period >= settings.lease)
    return out_of_bounds("the announcement period must be below the lease");
  return check_announcement(settings.announcement);
}

Locator_t udp_locator(const std::string& address, std::uint16_t port) {
  Locator_t result;
  IPLocator::createLocator(LOCATOR_KIND_UDPv4, address, port, result);
  return result;
}

RTPSParticipantAttributes make_attributes(const participant_settings& settings,
                                          std::uint16_t port) {
  RTPSParticipantAttributes result;
  result.setName("roscell");
  result.useBuiltinTransports = false;
  result.userTransports.push_back(
      guarded_udp_transport(settings.address, settings.max_message_bytes));
  result.userData.assign(settings.announcement.begin(),
                         settings.announcement.end());
  auto at = udp_locator(settings.address, port);
  result.builtin.metatrafficUnicastLocatorList.push_back(at);
  // Sharing the port saves a receiving thread and its buffer.
  result.defaultUnicastLocatorList.push_back(at);
  // All ports are given above, so nothing depends on the domain's own.
  result.port.domainIDGain = 0;
  result.builtin.use_WriterLivelinessProtocol = false;
  auto& discovery = result.builtin.discovery_config;
  discovery.leaseDuration = to_duration(settings.lease);
  discovery.leaseDuration_announcementperiod =
      to_duration(settings.announcement_period);
  discovery.initial_announcements.count = 1;
  keep_small(result.allocation);
  return result;
}

rtps_participant::rtps_participant(on_sighting callback, topic_watch* topics)
    : callback_(std::move(callback)), topics_(topics) {}

std::unique_ptr<rtps_participant>
rtps_participant::create(std::uint32_t domain_id,
                         RTPSParticipantAttributes attributes,
                         on_sighting callback, topic_watch* topics) {
  attributes.participantID = make_participant_id();
  std::unique_ptr<rtps_participant> result{
      new rtps_participant(std::move(callback), topics)};
  result->participant_ =
      RTPSDomain::createParticipant(domain_id, true, attributes, result.get());
  if (result->participant_ == nullptr)
    return nullptr;
  return result;
}

rtps_participant::~rtps_participant() {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    callback_ = nullptr;
  }
  if (participant_ != nullptr)
    RTPSDomain::removeRTPSParticipant(participant_);
}

void rtps_participant::update_announcement(const std::string& bytes) {
  auto attributes = participant_->getRTPSParticipantAttributes();
  attributes.userData.assign(bytes.begin(), bytes.end());
  participant_->update_attributes(attributes);
}

void rtps_participant::announce() {
  participant_->announceRTPSParticipantState();
}

std::uint16_t rtps_participant::port() const {
  auto& attributes = participant_->getRTPSParticipantAttributes();
  auto& locators = attributes.builtin.metatrafficUnicastLocatorList;
  return IPLocator::getPhysicalPort(*locators.begin());
}

void rtps_participant::onParticipantDiscovery(RTPSParticipant*,
                                              ParticipantDiscoveryInfo&& info) {
  auto seen = to_sighting(info);
  std::lock_guard<std::mutex> lock{mutex_};
  if (callback_)
    callback_(seen);
}

void rtps_participant::onWriterDiscovery(RTPSParticipant*,
                                         WriterDiscoveryInfo&& info) {
  if (topics_ == nullptr)
    return;
  std::ostringstream writer;
  writer << info.info.guid();
  if (info.status == WriterDiscoveryInfo::REMOVED_WRITER)
    topics_->remove(writer.str());
  else
    topics_->add(writer.str(), info.info.topicName().to_string(),
                 info.info.typeName().to_string());
}

} // namespace roscell
