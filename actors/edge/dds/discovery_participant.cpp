#include "actors/edge/dds/discovery_participant.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_transport.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/participant/RTPSParticipant.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>
#include <fastrtps/utils/IPLocator.h>

#include <algorithm>
#include <array>
#include <utility>

#include <pthread.h>

namespace roscell {

namespace {

using namespace eprosima::fastrtps::rtps;
using eprosima::fastrtps::Duration_t;

/// Wanted of the kernel, which lends memory only to datagrams that wait: so
/// that a server hears all of a large cell that starts at one moment.
constexpr std::uint32_t server_buffer_bytes = 4 * 1024 * 1024;

Duration_t to_duration(std::chrono::seconds x) {
  return {static_cast<std::int32_t>(x.count()), 0};
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

bool is_there(sighting::kind what) {
  return what == sighting::kind::appeared || what == sighting::kind::changed;
}

endpoint_guid to_guid(const GUID_t& x) {
  endpoint_guid result{};
  auto* end = std::copy(std::begin(x.guidPrefix.value),
                        std::end(x.guidPrefix.value), result.begin());
  std::copy(std::begin(x.entityId.value), std::end(x.entityId.value), end);
  return result;
}

/// `durability` is DDS 1.4's, 2.2.3.4: later ones promise more.
std::string durability_word(int durability) {
  constexpr std::array<const char*, 4> words{"volatile", "transient_local",
                                             "transient", "persistent"};
  const auto last = static_cast<int>(words.size()) - 1;
  return words.at(static_cast<std::size_t>(std::clamp(durability, 0, last)));
}

/// `data` is what is known of a reader or a writer.
template <class ProxyData>
void note(ros_graph& graph, const ProxyData& data, bool writes, bool gone) {
  const auto which = to_guid(data.guid());
  if (gone)
    return graph.remove(which);
  graph_endpoint end;
  end.topic = data.topicName().to_string();
  end.data_type = data.typeName().to_string();
  end.writes = writes;
  end.reliable = data.m_qos.m_reliability.kind
                 == eprosima::fastdds::dds::RELIABLE_RELIABILITY_QOS;
  end.durability = durability_word(data.m_qos.m_durability.kind);
  graph.add(which, std::move(end));
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

/// Names the threads that this one makes meanwhile: they inherit its name.
class name_of_threads {
public:
  explicit name_of_threads(const char* name) {
    pthread_getname_np(pthread_self(), before_.data(), before_.size());
    pthread_setname_np(pthread_self(), name);
  }

  ~name_of_threads() {
    pthread_setname_np(pthread_self(), before_.data());
  }

  name_of_threads(const name_of_threads&) = delete;
  name_of_threads& operator=(const name_of_threads&) = delete;

private:
  std::array<char, 16> before_{}; // As long as a name can be.
};

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

RTPSParticipantAttributes make_attributes(const participant_settings& settings,
                                          std::uint16_t port) {
  RTPSParticipantAttributes result;
  result.setName("roscell");
  result.useBuiltinTransports = false;
  result.userTransports.push_back(discovery_transport(
      {settings.address, settings.max_sent_bytes, settings.max_heard_bytes,
       settings.serves_programs ? server_buffer_bytes : 0,
       settings.serves_programs, settings.guard}));
  result.userData.assign(settings.announcement.begin(),
                         settings.announcement.end());
  auto at = udp_locator(settings.address, port);
  result.builtin.metatrafficUnicastLocatorList.push_back(at);
  // Sharing the port saves a socket.
  result.defaultUnicastLocatorList.push_back(at);
  // All ports are given above, so nothing depends on the domain's own.
  result.port.domainIDGain = 0;
  // Stock programs ask for it for ever where it is missing.
  result.builtin.use_WriterLivelinessProtocol = settings.serves_programs;
  auto& discovery = result.builtin.discovery_config;
  discovery.leaseDuration = to_duration(settings.lease);
  discovery.leaseDuration_announcementperiod =
      to_duration(settings.announcement_period);
  discovery.initial_announcements.count = 1;
  keep_small(result.allocation);
  return result;
}

rtps_participant::rtps_participant(on_sighting callback,
                                   std::shared_ptr<ros_graph> graph)
    : callback_(std::move(callback)), graph_(std::move(graph)) {}

std::unique_ptr<rtps_participant> rtps_participant::create(
    std::uint32_t domain_id, RTPSParticipantAttributes attributes,
    on_sighting callback, std::shared_ptr<ros_graph> graph) {
  attributes.participantID = make_participant_id();
  std::unique_ptr<rtps_participant> result{
      new rtps_participant(std::move(callback), std::move(graph))};
  const name_of_threads scope{"fast-dds"};
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
  if (graph_ && is_there(seen.what))
    graph_->name_participant(seen.prefix, seen.name);
  else if (graph_)
    graph_->remove_participant(seen.prefix);
  std::lock_guard<std::mutex> lock{mutex_};
  if (callback_)
    callback_(seen);
}

void rtps_participant::onReaderDiscovery(RTPSParticipant*,
                                         ReaderDiscoveryInfo&& info) {
  if (graph_)
    note(*graph_, info.info, false,
         info.status == ReaderDiscoveryInfo::REMOVED_READER);
}

void rtps_participant::onWriterDiscovery(RTPSParticipant*,
                                         WriterDiscoveryInfo&& info) {
  if (graph_)
    note(*graph_, info.info, true,
         info.status == WriterDiscoveryInfo::REMOVED_WRITER);
}

} // namespace roscell
