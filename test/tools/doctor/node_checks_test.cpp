#include "tools/roscell/doctor/node/asked_nodes.hpp"
#include "tools/roscell/doctor/node/camera_checks.hpp"
#include "tools/roscell/doctor/node/node_checks.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

TEST_CASE("a node of another version is a warning", "[doctor]") {
  node_description node;
  node.identity.name = "arm";
  node.version = "1.0";
  CHECK(judge_version(node, "1.0")[0].how == judgement::ok);
  CHECK(judge_version(node, "1.1")[0].how == judgement::warning);
}

TEST_CASE("what a node answers amiss is a finding", "[doctor]") {
  const auto problem = [](const auto& ask) {
    try {
      ask();
    } catch (const std::exception& e) {
      return finding_of_failure(e, judgement::broken);
    }
    return finding{};
  };
  // As a node of another version may.
  CHECK_THAT(problem([] {
               json{{"version", 7}}.get<node_description>();
             }).seen,
             Contains("the answer is not understood"));
  const json error{{"error", {{"code", "conflict"}, {"message", "it looks"}}}};
  CHECK(problem([&] { throw refused{error}; }).seen == "it looks");
}

TEST_CASE("a node that does not come into its cell says why", "[doctor]") {
  node_description node;
  node.identity.name = "arm";
  CHECK(judge_joining(node)[0].how == judgement::ok);
  node.joining.push_back(
      {"10.0.0.1:11811", "nothing listens", "start it", 3, 0});
  const auto found = judge_joining(node);
  CHECK(found[0].how == judgement::broken);
  CHECK_THAT(found[0].seen, Contains("10.0.0.1:11811: nothing listens"));
  CHECK(found[0].matters == "start it");
}

TEST_CASE("topics of which an end is missing or does not match are told",
          "[doctor]") {
  const topic_end end{"camera", "best_effort", "volatile"};
  CHECK(judge_topics({{{"/a", "t", {end}, {end}, {}}}})[0].how
        == judgement::ok);
  CHECK(judge_topics({{{"/rosout", "t", {end}, {}, {}}}})[0].how
        == judgement::ok);
  const auto found = judge_topics({{{"/a", "t", {end}, {end}, {"no match"}},
                                    {"/b", "t", {end}, {}, {}},
                                    {"/c", "t", {}, {end}, {}}}});
  REQUIRE(found.size() == 3);
  CHECK(found[0].how == judgement::broken);
  CHECK(found[1].seen == "nobody writes /c");
  CHECK(found[2].seen == "nobody reads /b");
}

TEST_CASE("a topic of two types has an end each", "[doctor]") {
  const topic_end end{"camera", "reliable", "volatile"};
  const auto found = judge_topics(
      {{{"/a", "old", {end}, {}, {}}, {"/a", "new", {}, {end}, {}}}});
  CHECK(found.size() == 2);
}

TEST_CASE("nodes that are away are told by name", "[doctor]") {
  cell_description cell;
  cell.nodes.resize(2);
  cell.nodes[0].state = row_state::active;
  cell.nodes[1].state = row_state::lost;
  cell.nodes[1].identity.name = "arm";
  const auto found = judge_cell(cell);
  REQUIRE(found.size() == 1);
  CHECK(found[0].seen == "arm is lost");
  cell.nodes.pop_back();
  CHECK(judge_cell(cell)[0].how == judgement::ok);
}

TEST_CASE("a camera that is not calibrated is broken for who reads it",
          "[doctor]") {
  const topic_end end{"camera", "reliable", "volatile"};
  topic_row topic{
      "/cam/camera_info", "sensor_msgs/msg/CameraInfo", {end}, {}, {}};
  const std::vector<double> zero(9);
  std::vector<double> some(9);
  some[0] = 615.5;
  CHECK(judge_camera(topic, some).how == judgement::ok);
  CHECK(judge_camera(topic, std::nullopt).how == judgement::skipped);
  CHECK(judge_camera(topic, zero).how == judgement::warning);
  topic.readers.push_back(end);
  const auto found = judge_camera(topic, zero);
  CHECK(found.how == judgement::broken);
  CHECK_THAT(found.seen, Contains("/cam/camera_info is all zero"));
  CHECK_THAT(found.remedy, Contains("image:=/cam/image"));
}

TEST_CASE("images that no skill can read are broken for who reads them",
          "[doctor]") {
  const topic_end end{"camera", "best_effort", "volatile"};
  topic_row topic{"/cam/image", "sensor_msgs/msg/Image", {end}, {}, {}};
  CHECK(judge_images(topic, std::nullopt).how == judgement::skipped);
  for (const auto* encoding : {"yuv422_yuy2", "bayer_rggb16", "nv12", "32FC1"})
    CHECK(judge_images(topic, seen_image{encoding, ""}).how == judgement::ok);
  CHECK(judge_images(topic, seen_image{"16UC2", ""}).how == judgement::warning);
  topic.readers.push_back(end);
  auto found = judge_images(topic, seen_image{"16UC2", ""});
  CHECK(found.how == judgement::broken);
  CHECK_THAT(found.seen, Contains("/cam/image") && Contains("'16UC2'"));
  CHECK_THAT(judge_images(topic, seen_image{"h264", ""}).seen,
             Contains("nothing is known"));
  found = judge_images(topic, seen_image{"", "field 'step': 5 bytes are few"});
  CHECK(found.how == judgement::broken);
  CHECK_THAT(found.seen, Contains("sizes lie: field 'step'"));
}
