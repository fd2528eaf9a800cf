#include "skills/ros2/participant.hpp"

#include "cell_fixture.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rmw_dds_common.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "skills/ros2/participant_qos.hpp"
#include "skills/ros2/serialized_type.hpp"

#include <fastdds/dds/subscriber/SampleInfo.hpp>

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::test;

namespace {

using info = ros2::rmw_dds_common::participant_entities_info;

/// What `ros2 node list` reads: the graph, as a participant of the cell.
class graph_reader : ros2::dds::DataReaderListener {
public:
  explicit graph_reader(const variables& environment) {
    auto config = ros2::read_participant_config(lookup_in(environment),
                                                engine::parameters{});
    participant_ = factory()->create_participant(
        config.domain_id, ros2::to_participant_qos(config));
    ros2::dds::TypeSupport{new ros2::serialized_type(ros2::graph_type)}
        .register_type(participant_);
    auto* topic = participant_->create_topic(
        ros2::graph_topic, ros2::graph_type, ros2::dds::TOPIC_QOS_DEFAULT);
    ros2::topic_qos qos;
    qos.transient_local = true;
    participant_->create_subscriber(ros2::dds::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(topic, ros2::to_reader_qos(qos), this);
  }

  ~graph_reader() override {
    participant_->delete_contained_entities();
    factory()->delete_participant(participant_);
  }

  /// Waits for a description of `node` with so many readers and writers.
  std::optional<info> wait_for(const std::string& node, std::size_t readers,
                               std::size_t writers) {
    auto fits = [&] {
      const auto& nodes = last_.node_entities_info_seq;
      return nodes.size() == 1 && nodes[0].node_name == node
             && nodes[0].reader_gid_seq.size() == readers
             && nodes[0].writer_gid_seq.size() == writers;
    };
    std::unique_lock guard{mutex_};
    if (!changed_.wait_for(guard, patience, fits))
      return std::nullopt;
    return last_;
  }

private:
  static ros2::dds::DomainParticipantFactory* factory() {
    return ros2::dds::DomainParticipantFactory::get_instance();
  }

  void on_data_available(ros2::dds::DataReader* reader) override {
    std::string payload;
    ros2::dds::SampleInfo sample;
    while (reader->take_next_sample(&payload, &sample)
           == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK) {
      std::lock_guard guard{mutex_};
      last_ = ros2::deserialize<info>(payload);
      changed_.notify_all();
    }
  }

  ros2::dds::DomainParticipant* participant_ = nullptr;
  std::mutex mutex_;
  std::condition_variable changed_;
  info last_;
};

} // namespace

TEST_CASE("the ROS graph shows a skill as a node with its topics") {
  cell home{3};
  skill shown{home.environment("task-1.poses")};
  auto output = shown.output("/out", ros2::std_msgs::string::type_name);
  graph_reader graph{home.environment("graph")};
  auto first = graph.wait_for("task_1_poses", 0, 1);
  REQUIRE(first);
  const auto& node = first->node_entities_info_seq[0];
  CHECK(node.node_namespace == "/");
  // The same participant, and a writer of a message without a key.
  CHECK(std::equal(first->gid.data.begin(), first->gid.data.begin() + 12,
                   node.writer_gid_seq[0].data.begin()));
  CHECK(first->gid.data[15] == 0xc1);
  CHECK(node.writer_gid_seq[0].data[15] == 0x03);
  CHECK(node.writer_gid_seq[0].data[16] == 0);
  {
    auto input = shown.input("/in", ros2::std_msgs::string::type_name);
    input->open();
    CHECK(graph.wait_for("task_1_poses", 1, 1));
  }
  CHECK(graph.wait_for("task_1_poses", 0, 1));
}
