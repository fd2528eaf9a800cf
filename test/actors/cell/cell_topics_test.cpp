#include "actors/cell/cell_topics.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

graph_endpoint end_of(const std::string& program, bool writes,
                      bool reliable = true,
                      const std::string& durability = "volatile") {
  return {"/scan", "sensor_msgs/msg/LaserScan", writes, reliable, durability,
          program};
}

std::vector<std::string> mismatches(const graph_endpoint& writer,
                                    const graph_endpoint& reader) {
  const auto rows = topic_rows({writer, reader}, "");
  REQUIRE(rows.size() == 1);
  return rows.front().mismatches;
}

} // namespace

TEST_CASE("ends of one topic and type are one row, by name") {
  auto other = end_of("c", true);
  other.topic = "/image";
  const auto rows =
      topic_rows({end_of("a", true), end_of("b", false), other}, "");
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].topic == "/image");
  CHECK(rows[1].writers
        == std::vector<topic_end>{{"a", "reliable", "volatile"}});
  CHECK(rows[1].readers
        == std::vector<topic_end>{{"b", "reliable", "volatile"}});
  CHECK(topic_rows({end_of("a", true), other}, "/scan").size() == 1);
}

TEST_CASE("who wants more than is offered is named, with the writer") {
  CHECK(mismatches(end_of("a", true, false), end_of("b", false, true))
        == std::vector<std::string>{
            "'b' wants reliable, but 'a' offers best_effort: nothing is sent "
            "from this one to that"});
  CHECK(
      mismatches(end_of("a", true), end_of("", false, true, "transient_local"))
      == std::vector<std::string>{
          "a program wants transient_local, but 'a' offers volatile: nothing "
          "is sent from this one to that"});
}

TEST_CASE("who wants no more than is offered matches") {
  CHECK(mismatches(end_of("a", true), end_of("b", false, false)).empty());
  CHECK(
      mismatches(end_of("a", true, true, "transient_local"), end_of("b", false))
          .empty());
}

TEST_CASE("ends of one name and different types are told of") {
  auto reader = end_of("b", false);
  reader.data_type = "std_msgs/msg/String";
  const auto rows = topic_rows({end_of("a", true), reader}, "/scan");
  REQUIRE(rows.size() == 2);
  CHECK(rows[1].mismatches
        == std::vector<std::string>{
            "'b' reads std_msgs/msg/String, but 'a' writes "
            "sensor_msgs/msg/LaserScan there"});
}

TEST_CASE("of many pairs that do not match only the first are told") {
  std::vector<graph_endpoint> ends;
  for (int i = 0; i < 40; ++i) {
    ends.push_back(end_of("w", true, false));
    ends.push_back(end_of("r", false, true));
  }
  CHECK(topic_rows(ends, "").front().mismatches.size() == 100);
}
