#include "actors/placement/reading/wiring.hpp"
#include "test/actors/placement/reading/pipelines.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

namespace {

const std::string image = "sensor_msgs/msg/Image";

io_endpoint topic(const std::string& name, const std::string& type = image) {
  return {"ros2", name, type, "", false};
}

io_endpoint file(const std::string& path) {
  return {"file", path, "text/plain", "", false};
}

written_step step(const std::string& id, const std::vector<io_endpoint>& input,
                  const std::vector<io_endpoint>& output) {
  written_step result;
  result.step.id = id;
  result.step.input = input;
  result.step.output = output;
  for (size_t i = 0; i < input.size(); ++i)
    result.input_at.push_back("/" + id + "/input/" + std::to_string(i));
  for (size_t i = 0; i < output.size(); ++i)
    result.output_at.push_back("/" + id + "/output/" + std::to_string(i));
  return result;
}

wiring wired(const std::vector<written_step>& steps,
             const std::vector<deployed_end>& cell = {}) {
  return find_wiring("mine", steps, cell);
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("A topic that a step of the task writes is wired", "[wiring]") {
  const auto x = wired(
      {step("r", {topic("/image")}, {}), step("w", {}, {topic("image")})});
  CHECK(x.errors.empty());
  CHECK(x.warnings.empty());
}

TEST_CASE("A topic that nobody writes is refused, with one of a near name",
          "[wiring]") {
  const auto x = wired({step("w", {}, {topic("/scene_1/image")}),
                        step("r", {topic("/scene_1/imge")}, {})});
  REQUIRE(x.errors.size() == 1);
  CHECK(x.errors[0].pointer == "/r/input/0");
  CHECK(says(x.errors[0].expected, R"(did you mean "/scene_1/image" of step )"
                                   R"("w" (at /w/output/0)?)"));
  const auto alone = wired({step("r", {topic("/scan")}, {})});
  REQUIRE(alone.errors.size() == 1);
  CHECK(says(alone.errors[0].expected, R"(say "external": true)"));
}

TEST_CASE("A topic of another task of the cell is wired", "[wiring]") {
  const std::vector<deployed_end> cell{{"other", "cam", "n", topic("/image")}};
  CHECK(wired({step("r", {topic("/image")}, {})}, cell).errors.empty());
  // The same task's own instances do not count: it is what is being read.
  const std::vector<deployed_end> own{{"mine", "cam", "n", topic("/image")}};
  CHECK(wired({step("r", {topic("/image")}, {})}, own).errors.size() == 1);
}

TEST_CASE("An external topic needs no writer, and has none in the task",
          "[wiring]") {
  auto end = topic("/scan");
  end.external = true;
  CHECK(wired({step("r", {end}, {})}).errors.empty());
  auto reader = step("r", {topic("/scan"), topic("/odom")}, {});
  reader.step.external = true;
  CHECK(wired({reader}).errors.empty());
  const auto both =
      wired({step("r", {end}, {}), step("w", {}, {topic("/scan")})});
  CHECK(both.errors.empty());
  REQUIRE(both.warnings.size() == 1);
  CHECK(says(both.warnings[0], "the topic is external"));
}

TEST_CASE("An external topic that nobody writes yet is said", "[wiring]") {
  auto end = topic("/scan");
  end.external = true;
  const std::vector<written_step> steps{step("r", {end}, {})};
  auto x = find_wiring("mine", steps, {}, std::vector<io_endpoint>{});
  CHECK(x.errors.empty());
  REQUIRE(x.warnings.size() == 1);
  CHECK(says(x.warnings[0], R"(nobody writes the external topic "/scan" yet)"));
  x = find_wiring("mine", steps, {}, std::vector<io_endpoint>{topic("/scan")});
  CHECK(x.warnings.empty());
  x = find_wiring("mine", steps, {},
                  std::vector<io_endpoint>{topic("/scan", "t/msg/T")});
  REQUIRE(x.warnings.size() == 1);
  CHECK(says(x.warnings[0], R"(is written as "t/msg/T")"));
}

TEST_CASE("Types that differ are refused with both places", "[wiring]") {
  const auto x =
      wired({step("w", {}, {topic("/image", "sensor_msgs/msg/CameraInfo")}),
             step("r", {topic("/image")}, {})});
  REQUIRE(x.errors.size() == 1);
  CHECK(x.errors[0].pointer == "/r/input/0");
  CHECK(says(x.errors[0].expected, R"(step "w" (at /w/output/0) writes)"));
}

TEST_CASE("Two writers of one topic are warned of, unless they share it",
          "[wiring]") {
  auto x = wired({step("a", {}, {topic("/x")}), step("b", {}, {topic("/x")})});
  CHECK(x.errors.empty());
  REQUIRE(x.warnings.size() == 1);
  CHECK(says(x.warnings[0], "at /b/output/0: "));
  CHECK(says(x.warnings[0], R"(step "a" (at /a/output/0))"));
  const auto tf = topic("/tf", "tf2_msgs/msg/TFMessage");
  CHECK(wired({step("a", {}, {tf}), step("b", {}, {tf})}).warnings.empty());
  x = wired({step("a", {}, {topic("/x")})}, {{"other", "s", "n", topic("/x")}});
  REQUIRE(x.warnings.size() == 1);
  CHECK(says(x.warnings[0], R"(step "s" of task "other" on 'n')"));
  x = wired(
      {step("a", {}, {topic("/x")}), step("b", {}, {topic("/x", "t/msg/T")})});
  CHECK(x.errors.size() == 1);
}

TEST_CASE("A file that two steps write is refused, unless labels part them",
          "[wiring]") {
  auto a = step("a", {}, {file("/tmp/out")});
  auto b = step("b", {}, {file("/tmp/out")});
  CHECK(wired({a, b}).errors.size() == 1);
  a.step.labels = {{"host", "one"}};
  b.step.labels = {{"host", "two"}};
  CHECK(wired({a, b}).errors.empty());
  const auto x = wired({a}, {{"other", "s", "n", file("/tmp/out")}});
  CHECK(x.errors.empty());
  CHECK(x.warnings.size() == 1);
}

TEST_CASE("A folder that two steps write into is warned of", "[wiring]") {
  auto pictures = file("/tmp/pictures");
  pictures.data_type = "image/png";
  const auto x = wired({step("a", {}, {pictures}), step("b", {}, {pictures})});
  CHECK(x.errors.empty());
  CHECK(x.warnings.size() == 1);
}

TEST_CASE("Steps that are joined by a file must share a node", "[wiring]") {
  const auto x = wired({step("a", {}, {file("/tmp/one/")}),
                        step("b", {file("/tmp/one")}, {file("/tmp/two")}),
                        step("c", {file("/other")}, {}),
                        step("d", {file("/tmp/two/x")}, {})});
  CHECK(x.errors.empty());
  CHECK(x.together == std::vector<uint64_t>{1, 1, 0, 1});
}

TEST_CASE("Steps that are joined by a file and kept apart are refused",
          "[wiring]") {
  auto a = step("a", {}, {file("/tmp/one")});
  auto b = step("b", {file("/tmp/one")}, {});
  a.step.labels = {{"host", "x"}};
  b.step.labels = {{"host", "y"}};
  const auto x = wired({a, b});
  REQUIRE(x.errors.size() == 1);
  CHECK(x.errors[0].pointer == "/b/input/0");
  CHECK(says(x.errors[0].expected, "host=y and host=x"));
}

TEST_CASE("Steps that pass frames on as actors must share a node", "[wiring]") {
  const io_endpoint poses{"actor", "/poses", image, "", false};
  const auto x = wired({step("a", {}, {poses}), step("b", {topic("/x")}, {}),
                        step("c", {poses}, {topic("/x")})});
  CHECK(x.errors.empty());
  CHECK(x.together == std::vector<uint64_t>{1, 0, 1});
}

TEST_CASE("A stream between actors that no step of the task writes is refused",
          "[wiring]") {
  const io_endpoint poses{"actor", "/poses", image, "", false};
  const auto x = wired({step("r", {poses}, {})}, {{"other", "w", "n", poses}});
  REQUIRE(x.errors.size() == 1);
  CHECK(x.errors[0].pointer == "/r/input/0");
  CHECK(says(x.errors[0].expected, "no step of this task writes the stream"));
}

namespace {

using order = std::vector<std::vector<size_t>>;

instance_spec spec(const std::string& input, const std::string& output) {
  instance_spec result;
  result.input = {{"file", input, "text/plain", "", false}};
  result.output = {{"file", output, "text/plain", "", false}};
  return result;
}

} // namespace

TEST_CASE("Who reads a file starts after who writes it", "[start_order]") {
  CHECK(start_order({spec("/a", "/b"), spec("/b", "/c"), spec("/x", "/y")})
        == order{{}, {0}, {}});
  CHECK(start_order({spec("/b", "/c"), spec("/a", "/b")}) == order{{1}, {}});
}

TEST_CASE("Who reads a topic waits for nobody", "[start_order]") {
  auto reader = spec("/a", "/b");
  auto writer = spec("/c", "/a");
  reader.input[0].protocol = "ros2";
  writer.output[0].protocol = "ros2";
  CHECK(start_order({reader, writer}) == order{{}, {}});
}

TEST_CASE("Of a circle of files somebody starts", "[start_order]") {
  CHECK(start_order({spec("/b", "/a"), spec("/a", "/b")}) == order{{}, {0}});
  const auto three =
      start_order({spec("/c", "/a"), spec("/a", "/b"), spec("/b", "/c")});
  CHECK(three == order{{}, {0}, {1}});
}

} // namespace roscell::test
