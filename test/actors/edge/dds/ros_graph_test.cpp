#include "actors/edge/dds/lives/server_lives.hpp"
#include "actors/edge/dds/ros_graph.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

/// Endpoint `number` of participant `who`.
endpoint_guid guid(std::uint8_t who, std::uint16_t number = 0) {
  endpoint_guid result{};
  result[0] = who;
  result[14] = static_cast<std::uint8_t>(number >> 8);
  result[15] = static_cast<std::uint8_t>(number);
  return result;
}

guid_prefix numbered_prefix(std::uint8_t who) {
  return {who};
}

graph_endpoint scan(bool writes = true) {
  return {"rt/scan",  "sensor_msgs::msg::dds_::LaserScan_",
          writes,     true,
          "volatile", ""};
}

} // namespace

TEST_CASE("the graph holds an end as long as it is there, in ROS 2's words") {
  ros_graph graph;
  graph.add(guid(1), scan());
  graph.add(guid(2), scan(false));
  graph.name_participant(numbered_prefix(2), "/");
  CHECK(graph.endpoints()
        == std::vector<graph_endpoint>{
            {"/scan", "sensor_msgs/msg/LaserScan", true, true, "volatile", ""},
            {"/scan", "sensor_msgs/msg/LaserScan", false, true, "volatile",
             "/"}});
  graph.remove(guid(1));
  CHECK(graph.endpoints().size() == 1);
}

TEST_CASE("servers of whichever life are told from programs") {
  ros_graph graph;
  graph.name_participant(server_prefix(3), "roscell");
  server_lives lives{1};
  lives.lose(4);
  const auto later = lives.present(4);
  REQUIRE(later != server_prefix(4));
  graph.name_participant(later, "roscell");
  graph.name_participant(later, "roscell");
  auto program = later;
  program[1] = 0;
  graph.name_participant(program, "/");
  CHECK(graph.participants().servers == 2);
  CHECK(graph.participants().programs == 1);
  graph.remove_participant(later);
  CHECK(graph.participants().servers == 1);
}

TEST_CASE("the ends of a participant go with it") {
  ros_graph graph;
  graph.add(guid(1, 1), scan());
  graph.add(guid(1, 2), scan(false));
  graph.add(guid(2, 1), scan());
  graph.remove_participant(numbered_prefix(1));
  CHECK(graph.endpoints().size() == 1);
}

TEST_CASE("what is no ROS 2 topic is not in the graph") {
  ros_graph graph;
  const auto add = [&](std::uint16_t n, std::string topic, std::string type) {
    auto end = scan();
    end.topic = std::move(topic);
    end.data_type = std::move(type);
    graph.add(guid(1, n), end);
  };
  add(1, "rq/add_two_intsRequest", "a::srv::dds_::B_Request_");
  add(2, "HelloWorldTopic", "HelloWorld");
  add(3, "rt/x", "HelloWorld");
  add(4, "rt/x", "");
  CHECK(graph.endpoints().empty());
}

TEST_CASE("a flood of ends is bounded, and known ones can still change") {
  ros_graph graph;
  for (std::uint16_t i = 0; i < ros_graph::most_endpoints + 10; ++i)
    graph.add(guid(1, i), scan());
  CHECK(graph.endpoints().size() == ros_graph::most_endpoints);
  auto changed = scan();
  changed.topic = "rt/other";
  graph.add(guid(1, 0), changed);
  CHECK(graph.endpoints().front().topic == "/other");
}

TEST_CASE("who watches the graph is told once until it has looked") {
  ros_graph graph;
  graph.add(guid(1), scan());
  int calls = 0;
  graph.watch([&] { ++calls; });
  CHECK(calls == 1); // Of what was there before.
  graph.add(guid(2), scan());
  CHECK(calls == 1);
  CHECK(graph.endpoints().size() == 2);
  graph.remove(guid(2));
  CHECK(calls == 2);
  graph.remove(guid(2)); // Changes nothing.
  CHECK(graph.endpoints().size() == 1);
  graph.remove(guid(7));
  CHECK(calls == 2);
}

TEST_CASE("with the last server all that is known of anybody ends") {
  ros_graph graph;
  int calls = 0;
  graph.watch([&] { ++calls; });
  CHECK_FALSE(graph.is_served());
  graph.endpoints();
  graph.begin_service();
  CHECK(calls == 2);
  CHECK(graph.is_served());
  graph.add(guid(1), scan());
  // The next one begins before this one has ended.
  graph.begin_service();
  graph.end_service();
  CHECK(graph.is_served());
  CHECK(graph.endpoints().size() == 1);
  graph.end_service();
  CHECK(calls == 3);
  CHECK_FALSE(graph.is_served());
  CHECK(graph.endpoints().empty());
}
