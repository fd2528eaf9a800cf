#include "tools/roscell/view/graph/task_graph.hpp"

#include "tools/roscell/view/graph/graph_view.hpp"

#include "test/words.hpp"

#include <catch2/catch.hpp>

using namespace roscell;
using namespace roscell::cli;

namespace {

instance_row step(const std::string& name, std::vector<io_endpoint> input,
                  std::vector<io_endpoint> output) {
  instance_row result;
  result.spec.step = name;
  result.spec.input = std::move(input);
  result.spec.output = std::move(output);
  result.node = "arm-1";
  result.state = instance_state::running;
  return result;
}

const io_endpoint pictures{"file", "/data/in", "image/png"};
const io_endpoint image{"ros2", "/image", "sensor_msgs/msg/Image"};
const io_endpoint tf{"ros2", "/tf", "tf2_msgs/msg/TFMessage"};

task_graph sample_graph() {
  auto camera = step("camera", {pictures}, {image});
  camera.metrics = {120, 10, 0, 3.25};
  return graph_of("t", {camera, step("poses", {image}, {tf})});
}

using roscell::test::has;

} // namespace

TEST_CASE("an output that is another step's input joins the two", "[tools]") {
  const auto graph = sample_graph();
  REQUIRE(graph.streams.size() == 3);
  CHECK_FALSE(graph.streams[0].from);
  CHECK(graph.streams[0].to == 0);
  CHECK(graph.streams[1].what == image);
  CHECK(graph.streams[1].from == 0);
  CHECK(graph.streams[1].to == 1);
  CHECK(graph.streams[2].from == 1);
  CHECK_FALSE(graph.streams[2].to);
}

TEST_CASE("the same endpoint of another protocol joins nothing", "[tools]") {
  auto other = image;
  other.protocol = "file";
  const auto graph =
      graph_of("t", {step("a", {}, {image}), step("b", {other}, {})});
  for (const auto& x : graph.streams)
    CHECK_FALSE((x.from && x.to));
}

TEST_CASE("a graph shows steps, nodes, streams and metrics", "[tools]") {
  const auto text = graph_view(sample_graph(), {});
  CHECK(has(text, "│ on arm-1, running "));
  CHECK(has(text, "│ 10 Hz, 0 dropped, 3.25 ms "));
  CHECK(has(text, "│ in  /data/in "));
  CHECK(has(text, "┌─│ out /image  Image  10 Hz "));
  CHECK(has(text, "└▶│ in  /image "));
  CHECK(has(text, "│ out /tf"));
  CHECK(has(text, "\n/image    camera  poses   10 Hz  ros2      "
                  "sensor_msgs/msg/Image\n"));
}

TEST_CASE("a graph shows what arrives at each reader", "[tools]") {
  auto graph = sample_graph();
  stream_count out;
  out.end = "output:0";
  out.rate_hz = 9;
  graph.steps[0].metrics.streams = {out};
  stream_count in;
  in.end = "input:0";
  in.frames = 7;
  in.failed = 2;
  in.rate_hz = 8;
  graph.steps[1].metrics.streams = {in};
  const auto text = graph_view(graph, {});
  CHECK(has(text, "┌─│ out /image  Image  9 Hz "));
  CHECK(has(text, "AT ITS READER"));
  CHECK(has(text, "  8 Hz, 7 frames, 2 failed\n"));
  const auto document = graph_json(graph);
  CHECK(document.at("streams").at(1).at("written").at("rate_hz") == 9);
  CHECK(document.at("streams").at(1).at("read").at("failed") == 2);
  CHECK(document.at("streams").at(0).at("written").is_null());
}

TEST_CASE("a step whose node is away is not shown as running", "[tools]") {
  auto lost = step("camera", {}, {image});
  lost.unknown_since_unix_ms = 1000;
  CHECK(has(graph_view(graph_of("t", {lost}), {}), "on arm-1, unknown "));
}

TEST_CASE("a graph is told to other programs", "[tools]") {
  const auto dot = dot_text(sample_graph());
  CHECK(has(dot, "digraph \"t\" {\n"));
  CHECK(has(dot, "s0 [label=\"camera\\non arm-1\\n10 Hz, 0 dropped"));
  CHECK(has(dot, "s0 -> s1 [label=\"/image\"];\n"));
  const auto mermaid = mermaid_text(sample_graph());
  CHECK(has(mermaid, "flowchart TB\n"));
  CHECK(has(mermaid, "s0 -->|\"/image\"| s1\n"));
  const auto document = graph_json(sample_graph());
  CHECK(document.at("name") == "t");
  CHECK(document.at("streams").at(1).at("from") == "camera");
  CHECK(document.at("streams").at(2).at("to").is_null());
  CHECK(document.at("steps").at(0).at("figures").at("rate_hz") == 10);
}

TEST_CASE("no name of a step ends the text of another language", "[tools]") {
  const auto graph = graph_of("t", {step("a\"];evil", {}, {})});
  CHECK(has(dot_text(graph), "\"a'];evil\\non arm-1\""));
}
