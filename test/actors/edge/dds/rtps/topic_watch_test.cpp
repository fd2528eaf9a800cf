#include "actors/edge/dds/rtps/topic_watch.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

TEST_CASE("a topic is watched as long as somebody writes it") {
  topic_watch watch;
  watch.add("1", "rt/scan", "sensor_msgs::msg::dds_::LaserScan_");
  watch.add("2", "rt/scan", "sensor_msgs::msg::dds_::LaserScan_");
  const written_topic scan{"/scan", "sensor_msgs/msg/LaserScan"};
  CHECK(watch.topics() == std::vector<written_topic>{scan, scan});
  watch.remove("1");
  CHECK(watch.topics() == std::vector<written_topic>{scan});
  watch.remove("2");
  CHECK(watch.topics().empty());
}

TEST_CASE("what is no ROS 2 topic is not watched") {
  topic_watch watch;
  watch.add("1", "rq/add_two_intsRequest", "a::srv::dds_::B_Request_");
  watch.add("2", "HelloWorldTopic", "HelloWorld");
  watch.add("3", "rt/x", "HelloWorld");
  watch.add("4", "rt/x", "");
  CHECK(watch.topics().empty());
}

TEST_CASE("a flood of writers is bounded, and known ones can still change") {
  topic_watch watch;
  for (size_t i = 0; i < topic_watch::most_writers + 10; ++i)
    watch.add(std::to_string(i), "rt/a", "p::msg::dds_::T_");
  CHECK(watch.topics().size() == topic_watch::most_writers);
  watch.add("0", "rt/b", "p::msg::dds_::T_");
  CHECK(watch.topics().front().topic == "/b");
}
