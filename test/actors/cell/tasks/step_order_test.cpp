#include "actors/cell/tasks/task_views.hpp"

#include <catch2/catch.hpp>

using namespace roscell;

namespace {

io_endpoint topic(const std::string& name) {
  return {"ros2", name, "std_msgs/msg/String"};
}

instance_row step(const std::string& name, const std::vector<std::string>& in,
                  const std::vector<std::string>& out) {
  instance_row result;
  result.spec.step = name;
  for (const auto& x : in)
    result.spec.input.push_back(topic(x));
  for (const auto& x : out)
    result.spec.output.push_back(topic(x));
  return result;
}

std::string sorted(std::vector<instance_row> steps) {
  sort_by_flow(steps);
  std::string result;
  for (const auto& x : steps)
    result += x.spec.step;
  return result;
}

} // namespace

TEST_CASE("a step stands behind all that it gets something from", "[cell]") {
  const auto a = step("a", {}, {"/a"});
  const auto b = step("b", {"/a"}, {"/b"});
  const auto c = step("c", {"/a", "/b"}, {});
  CHECK(sorted({a, b, c}) == "abc");
  CHECK(sorted({c, b, a}) == "abc");
  CHECK(sorted({b, c, a}) == "abc");
}

TEST_CASE("steps that get nothing from each other stay as they were",
          "[cell]") {
  CHECK(sorted({}).empty());
  CHECK(sorted({step("b", {}, {"/b"}), step("a", {}, {"/a"})}) == "ba");
  CHECK(sorted({step("x", {"/a"}, {}), step("a", {}, {"/a"}),
                step("y", {"/a"}, {}), step("b", {}, {"/a"})})
        == "abxy");
}

TEST_CASE("the same endpoint of another protocol joins no steps", "[cell]") {
  auto reader = step("r", {"/a"}, {});
  reader.spec.input[0].protocol = "file";
  CHECK(sorted({reader, step("w", {}, {"/a"})}) == "rw");
}

TEST_CASE("data that flow in a circle begin at the step that came first",
          "[cell]") {
  const auto a = step("a", {"/b"}, {"/a"});
  const auto b = step("b", {"/a"}, {"/b"});
  CHECK(sorted({a, b}) == "ab");
  CHECK(sorted({b, a}) == "ba");
  CHECK(sorted({step("a", {"/a"}, {"/a"})}) == "a");
}
