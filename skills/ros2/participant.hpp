#pragma once

#include "skills/ros2/flow/pace.hpp"
#include "skills/ros2/participant_config.hpp"
#include "skills/ros2/topic_qos.hpp"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

namespace roscell::ros2 {

/// GUID of a participant or an endpoint: its prefix and its entity id.
using guid = std::array<std::uint8_t, 16>;

/// One participant and its one ROS 2 node, as the ROS graph shows them.
struct graph_node {
  guid participant{};
  std::string name; ///< Without a namespace.
  std::vector<guid> readers;
  std::vector<guid> writers;
};

/// On this topic, without a prefix, all participants describe themselves.
constexpr const char* graph_topic = "ros_discovery_info";

/// The DDS name of what they write there.
constexpr const char* graph_type =
    "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

/// A rmw_dds_common/msg/ParticipantEntitiesInfo. `gid_bytes` is 16 or 24: ROS 2
/// Humble and the later versions cannot read each other's.
std::string serialize(const graph_node& node, std::size_t gid_bytes);

// INTERNAL to this folder.

namespace dds = eprosima::fastdds::dds;

guid to_guid(const eprosima::fastrtps::rtps::GUID_t& x);

/// A ROS 2 node without ROS 2: a DDS participant that others take for one. It
/// speaks by UDP only, because shared memory does not reach from one container
/// into another, and fails there without a word.
class participant : private dds::DomainParticipantListener {
public:
  /// Throws engine::start_error, also where there is no port to listen on: it
  /// would be deaf without a word.
  explicit participant(participant_config config);

  ~participant() override;

  /// The names are those of ROS 2. The listener must live until `remove`.
  /// Throws engine::start_error.
  dds::DataReader* add_reader(const std::string& topic, const std::string& type,
                              const topic_qos& qos,
                              dds::DataReaderListener* listener);
  dds::DataWriter* add_writer(const std::string& topic, const std::string& type,
                              const topic_qos& qos,
                              dds::DataWriterListener* listener);

  /// The same by their names in DDS, as services have them.
  dds::DataReader* add_named_reader(const std::string& topic,
                                    const std::string& type,
                                    const topic_qos& qos,
                                    dds::DataReaderListener* listener);
  dds::DataWriter* add_named_writer(const std::string& topic,
                                    const std::string& type,
                                    const topic_qos& qos,
                                    dds::DataWriterListener* listener);

  const std::string& node_name() const {
    return config_.node_name;
  }

  /// Waits for the listener's call that is under way. Not to be called by it.
  void remove(dds::DataReader* reader);
  void remove(dds::DataWriter* writer);

  datagram_pacer& pacer() {
    return *pacer_;
  }

  /// Whether a reader is best effort and of a stock program, whose enclave, its
  /// participant's name, begins with '/': what it loses nobody sends again.
  bool is_best_effort_reader(const guid& reader);

private:
  struct deleter {
    void operator()(dds::DomainParticipant* x) const;
  };

  void make_participant();
  dds::Topic* find_topic(const std::string& name, const std::string& type);
  dds::DataWriter* make_writer(dds::Topic* topic, const topic_qos& qos,
                               dds::DataWriterListener* listener);
  void publish_graph();

  void on_participant_discovery(
      dds::DomainParticipant* self,
      eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_subscriber_discovery(
      dds::DomainParticipant* self,
      eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;

  const participant_config config_;
  const std::shared_ptr<datagram_pacer> pacer_ =
      std::make_shared<datagram_pacer>();
  std::mutex others_mutex_; // Guards what is known of others.
  std::set<guid> stock_programs_;
  std::set<guid> best_effort_readers_;
  std::set<std::uint32_t> ports_; // Listened on; filled while it is made.
  std::unique_ptr<dds::DomainParticipant, deleter> participant_;
  dds::Subscriber* subscriber_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::DataWriter* graph_writer_ = nullptr;
  std::mutex mutex_; // Guards what the graph shows.
  graph_node node_;
};

/// Gives all ports of a skill the same participant, made for the first one.
class shared_participant {
public:
  explicit shared_participant(engine::variable_lookup lookup);

  /// Throws engine::start_error. To be called from one thread.
  std::shared_ptr<participant> get(const engine::parameters& options);

  /// The next participant, once all ports have let go of this one, is made by
  /// these values of variables. To be called by the same thread.
  void use(const engine::changed_variables& reported);

private:
  const char* look_up(const char* name) const;

  const engine::variable_lookup lookup_;
  engine::changed_variables reported_;
  std::weak_ptr<participant> participant_;
};

} // namespace roscell::ros2
