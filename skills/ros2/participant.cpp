#include "skills/ros2/participant.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rmw_dds_common.hpp"
#include "roscell/ros2/rmw_dds_common_iron.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/participant_qos.hpp"
#include "skills/ros2/serialized_type.hpp"

#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>

#include <algorithm>
#include <utility>

namespace roscell::ros2 {

namespace {

using engine::start_error;

void erase(std::vector<guid>& from, const guid& x) {
  from.erase(std::remove(from.begin(), from.end(), x), from.end());
}

/// The participant that an endpoint is of.
guid program_of(guid endpoint) {
  constexpr std::size_t prefix_bytes = 12;
  std::fill(endpoint.begin() + prefix_bytes, endpoint.end(), std::uint8_t{0});
  return endpoint;
}

/// Those who come later read the last one.
topic_qos graph_qos() {
  topic_qos result;
  result.transient_local = true;
  result.depth = 1;
  return result;
}

/// Of discovery and of messages, which share one where there is a server.
std::size_t ports_wanted(const participant_config& config) {
  return config.servers.empty() ? 2 : 1;
}

} // namespace

guid to_guid(const eprosima::fastrtps::rtps::GUID_t& x) {
  guid result{};
  auto* end = std::copy(std::begin(x.guidPrefix.value),
                        std::end(x.guidPrefix.value), result.begin());
  std::copy(std::begin(x.entityId.value), std::end(x.entityId.value), end);
  return result;
}

void participant::deleter::operator()(dds::DomainParticipant* x) const {
  x->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(x);
}

participant::participant(participant_config config)
    : config_(std::move(config)) {
  make_participant();
  subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
  publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
  graph_writer_ =
      make_writer(find_topic(graph_topic, graph_type), graph_qos(), nullptr);
  node_.participant = to_guid(participant_->guid());
  node_.name = config_.node_name;
  publish_graph();
}

void participant::make_participant() {
  const auto qos = to_participant_qos(
      config_, pacer_, [this](std::uint32_t port) { ports_.insert(port); });
  participant_.reset(
      dds::DomainParticipantFactory::get_instance()->create_participant(
          config_.domain_id, qos, this, dds::StatusMask::none()));
  if (!participant_)
    throw start_error("Fast DDS does not create a participant in ROS domain "
                      + std::to_string(config_.domain_id)
                      + "; its message is above this one");
  if (ports_.size() < ports_wanted(config_))
    throw start_error("all UDP ports that DDS tries in ROS domain "
                      + std::to_string(config_.domain_id)
                      + " are taken on this host; end programs that are not "
                        "needed, or use another domain");
}

/// Nothing calls the listener any more once the participant is gone.
participant::~participant() {
  if (participant_)
    participant_->set_listener(nullptr);
  participant_.reset();
}

bool participant::is_best_effort_reader(const guid& reader) {
  const std::lock_guard guard{others_mutex_};
  return best_effort_readers_.count(reader) > 0
         && stock_programs_.count(program_of(reader)) > 0;
}

void participant::on_participant_discovery(
    dds::DomainParticipant*,
    eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) {
  using eprosima::fastrtps::rtps::ParticipantDiscoveryInfo;
  const auto who = program_of(to_guid(info.info.m_guid));
  const bool is_there =
      info.status == ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT
      || info.status == ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT;
  const std::string name = info.info.m_participantName.c_str();
  const std::lock_guard guard{others_mutex_};
  if (is_there && name.substr(0, 1) == "/")
    stock_programs_.insert(who);
  else
    stock_programs_.erase(who);
}

void participant::on_subscriber_discovery(
    dds::DomainParticipant*,
    eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) {
  using eprosima::fastrtps::rtps::ReaderDiscoveryInfo;
  const auto which = to_guid(info.info.guid());
  const bool is_best_effort =
      info.info.m_qos.m_reliability.kind == dds::BEST_EFFORT_RELIABILITY_QOS;
  const std::lock_guard guard{others_mutex_};
  if (is_best_effort && info.status != ReaderDiscoveryInfo::REMOVED_READER)
    best_effort_readers_.insert(which);
  else
    best_effort_readers_.erase(which);
}

dds::DataReader* participant::add_reader(const std::string& topic,
                                         const std::string& type,
                                         const topic_qos& qos,
                                         dds::DataReaderListener* listener) {
  return add_named_reader(dds_topic_name(topic), dds_type_name(type), qos,
                          listener);
}

dds::DataReader*
participant::add_named_reader(const std::string& topic, const std::string& type,
                              const topic_qos& qos,
                              dds::DataReaderListener* listener) {
  auto* result = subscriber_->create_datareader(find_topic(topic, type),
                                                to_reader_qos(qos), listener);
  if (result == nullptr)
    throw start_error("Fast DDS does not create a reader of '" + topic + "'");
  std::lock_guard guard{mutex_};
  node_.readers.push_back(to_guid(result->guid()));
  publish_graph();
  return result;
}

dds::DataWriter* participant::add_writer(const std::string& topic,
                                         const std::string& type,
                                         const topic_qos& qos,
                                         dds::DataWriterListener* listener) {
  return add_named_writer(dds_topic_name(topic), dds_type_name(type), qos,
                          listener);
}

dds::DataWriter*
participant::add_named_writer(const std::string& topic, const std::string& type,
                              const topic_qos& qos,
                              dds::DataWriterListener* listener) {
  auto* result = make_writer(find_topic(topic, type), qos, listener);
  std::lock_guard guard{mutex_};
  node_.writers.push_back(to_guid(result->guid()));
  publish_graph();
  return result;
}

void participant::remove(dds::DataReader* reader) {
  {
    std::lock_guard guard{mutex_};
    erase(node_.readers, to_guid(reader->guid()));
    publish_graph();
  }
  subscriber_->delete_datareader(reader);
}

void participant::remove(dds::DataWriter* writer) {
  {
    std::lock_guard guard{mutex_};
    erase(node_.writers, to_guid(writer->guid()));
    publish_graph();
  }
  publisher_->delete_datawriter(writer);
}

dds::Topic* participant::find_topic(const std::string& name,
                                    const std::string& type) {
  if (auto* known = participant_->lookup_topicdescription(name)) {
    if (known->get_type_name() != type)
      throw start_error("this step uses the topic '" + name
                        + "' with two types, '" + known->get_type_name()
                        + "' and '" + type + "'");
    return static_cast<dds::Topic*>(known);
  }
  if (participant_->find_type(type).empty())
    dds::TypeSupport{new serialized_type(type)}.register_type(
        participant_.get());
  auto* result = participant_->create_topic(name, type, dds::TOPIC_QOS_DEFAULT);
  if (result == nullptr)
    throw start_error("Fast DDS does not create the topic '" + name + "'");
  return result;
}

dds::DataWriter* participant::make_writer(dds::Topic* topic,
                                          const topic_qos& qos,
                                          dds::DataWriterListener* listener) {
  auto* result =
      publisher_->create_datawriter(topic, to_writer_qos(qos), listener);
  if (result == nullptr)
    throw start_error("Fast DDS does not create a writer of '"
                      + topic->get_name() + "'");
  return result;
}

void participant::publish_graph() {
  auto message = serialize(node_, config_.gid_bytes);
  graph_writer_->write(&message);
}

shared_participant::shared_participant(engine::variable_lookup lookup)
    : lookup_(std::move(lookup)) {
  // nop
}

std::shared_ptr<participant>
shared_participant::get(const engine::parameters& options) {
  auto result = participant_.lock();
  if (!result) {
    result = std::make_shared<participant>(read_participant_config(
        [this](const char* name) { return look_up(name); }, options));
    participant_ = result;
  }
  return result;
}

void shared_participant::use(const engine::changed_variables& reported) {
  reported_ = reported;
}

const char* shared_participant::look_up(const char* name) const {
  const auto i = reported_.find(name);
  return i != reported_.end() ? i->second.c_str() : lookup_(name);
}

namespace {

template <class Gid>
Gid to_gid(const guid& x) {
  Gid result;
  std::copy(x.begin(), x.end(), result.data.begin());
  return result;
}

template <class Gid>
auto to_gids(const std::vector<guid>& list) {
  std::vector<Gid> result(list.size());
  std::transform(list.begin(), list.end(), result.begin(), to_gid<Gid>);
  return result;
}

template <class Message>
std::string serialize_as(const graph_node& node) {
  using gid = decltype(Message::gid);
  Message message;
  message.gid = to_gid<gid>(node.participant);
  message.node_entities_info_seq = {
      {"/", node.name, to_gids<gid>(node.readers), to_gids<gid>(node.writers)}};
  return serialize(message);
}

} // namespace

std::string serialize(const graph_node& node, std::size_t gid_bytes) {
  using humble = rmw_dds_common::participant_entities_info;
  using iron = rmw_dds_common_iron::participant_entities_info;
  return gid_bytes == 16 ? serialize_as<iron>(node)
                         : serialize_as<humble>(node);
}

} // namespace roscell::ros2
