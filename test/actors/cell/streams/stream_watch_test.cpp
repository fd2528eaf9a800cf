#include "actors/cell/streams/stream_watch.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using Catch::Matchers::Contains;

namespace {

using names = std::vector<std::string>;

const io_endpoint watched_topic{"ros2", "/image", "sensor_msgs/msg/Image"};

/// A step that writes a topic and one that reads it, each on its node.
struct watched_pair {
  watched_pair() {
    for (auto* row : {&writer, &reader}) {
      row->spec.task = "t";
      row->state = instance_state::running;
    }
    writer.spec.instance = writer.spec.step = "camera";
    writer.node = "belt";
    writer.spec.output = {watched_topic};
    writer.metrics.streams = {count("output:0", 500)};
    writer.metrics.streams[0].steady_s = 12;
    reader.spec.instance = reader.spec.step = "poses";
    reader.node = "arm";
    reader.spec.input = {watched_topic};
    reader.metrics.streams = {count("input:0", 100)};
    reader.metrics.streams[0].quiet_s = 14.5;
  }

  static stream_count count(const std::string& end, int64_t frames) {
    stream_count result;
    result.end = end;
    result.frames = frames;
    return result;
  }

  names judge(const std::set<std::string>& reported = {"arm", "belt"}) {
    return watch.judge({&writer, &reader}, reported);
  }

  bool is_starved() const {
    return watch.reason_of("poses") != nullptr;
  }

  instance_row writer;
  instance_row reader;
  stream_watch watch;
};

} // namespace

TEST_CASE_METHOD(watched_pair, "a reader that gets nothing of what its writer "
                               "goes on sending is starved") {
  CHECK(judge() == names{"poses"});
  REQUIRE(is_starved());
  CHECK_THAT(*watch.reason_of("poses"),
             Contains("input '/image' has had no frame for 14 s")
                 && Contains("step 'camera' on node 'belt' goes on sending"));
  CHECK_FALSE(watch.reason_of("camera"));
  // It is said once.
  CHECK(judge().empty());
  SECTION("until it gets something") {
    reader.metrics.streams[0].quiet_s = 0;
    CHECK(judge() == names{"poses"});
    CHECK_FALSE(is_starved());
  }
  SECTION("or does not run") {
    reader.state = instance_state::backing_off;
    CHECK(judge().empty());
    CHECK_FALSE(is_starved());
  }
  SECTION("or is forgotten") {
    watch.forget("poses");
    CHECK_FALSE(is_starved());
  }
  SECTION("or its writer sends no more") {
    writer.metrics.streams[0].steady_s = -1;
    CHECK(judge() == names{"poses"});
  }
}

TEST_CASE_METHOD(watched_pair, "a topic is one whichever tasks its ends are "
                               "of") {
  writer.spec.task = "u";
  CHECK(judge() == names{"poses"});
  REQUIRE(is_starved());
  CHECK_THAT(*watch.reason_of("poses"),
             Contains("step 'camera' of task 'u' on node 'belt' goes on"));
}

TEST_CASE_METHOD(watched_pair, "a reader that never had a frame is told so") {
  reader.metrics.streams[0].frames = 0;
  judge();
  REQUIRE(is_starved());
  CHECK_THAT(*watch.reason_of("poses"), Contains("has had no frame at all"));
}

TEST_CASE_METHOD(watched_pair, "a reader is not starved before it is certain") {
  SECTION("it has not been quiet for long") {
    reader.metrics.streams[0].quiet_s = 9;
  }
  SECTION("its writer has not sent for long") {
    writer.metrics.streams[0].steady_s = 9;
  }
  SECTION("its skill tells nothing of its streams") {
    reader.metrics.streams.clear();
  }
  SECTION("its writer's skill does not") {
    writer.metrics.streams.clear();
  }
  SECTION("its writer does not run") {
    writer.state = instance_state::starting;
  }
  SECTION("the topic is another one") {
    writer.spec.output[0].endpoint = "/other";
  }
  SECTION("what is written there is of another type") {
    writer.spec.output[0].data_type = "sensor_msgs/msg/CompressedImage";
  }
  SECTION("it reads what it writes itself") {
    reader.spec.output = {watched_topic};
    reader.metrics.streams.push_back(writer.metrics.streams[0]);
    writer.spec.output.clear();
  }
  SECTION("it reads a file") {
    writer.spec.output[0].protocol = "file";
    reader.spec.input[0].protocol = "file";
  }
  CHECK(judge().empty());
  CHECK_FALSE(is_starved());
}

TEST_CASE_METHOD(watched_pair, "what a node has not told is judged as before") {
  SECTION("of a reader") {
    CHECK(judge({"belt"}).empty());
    CHECK_FALSE(is_starved());
    judge();
    reader.metrics = {};
    CHECK(judge({"belt"}).empty());
    CHECK(is_starved());
  }
  SECTION("of its writer") {
    CHECK(judge({"arm"}).empty());
    judge();
    writer.metrics = {};
    CHECK(judge({"arm"}).empty());
    CHECK(is_starved());
  }
}

TEST_CASE_METHOD(watched_pair, "one of several writers is enough") {
  auto other = writer;
  other.spec.instance = other.spec.step = "camera-2";
  other.metrics.streams[0].steady_s = -1;
  watch.judge({&other, &writer, &reader}, {"arm", "belt"});
  CHECK(is_starved());
}

TEST_CASE_METHOD(watched_pair, "a writer that nobody hears of hides no other "
                               "one") {
  auto away = writer;
  away.spec.instance = away.spec.step = "camera-2";
  away.node = "away";
  away.metrics = {};
  watch.judge({&away, &writer, &reader}, {"arm", "belt"});
  CHECK(is_starved());
  // Who gets something is not starved, whoever else may write.
  reader.metrics.streams[0].quiet_s = 0;
  watch.judge({&away, &writer, &reader}, {"arm", "belt"});
  CHECK_FALSE(is_starved());
}

TEST_CASE_METHOD(watched_pair, "those are asked that run a task or write what "
                               "it reads") {
  writer.spec.task = "u";
  auto other = writer;
  other.node = "far";
  other.spec.output[0].endpoint = "/other";
  const std::vector<const instance_row*> all{&writer, &reader, &other};
  CHECK(nodes_around(all, {&reader}) == std::set<std::string>{"arm", "belt"});
  CHECK(nodes_around(all, {&writer}) == std::set<std::string>{"belt"});
  reader.state = instance_state::stopped;
  CHECK(nodes_around(all, {&reader}).empty());
}

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
