#include "actors/placement/reading/start_order.hpp"

#include <catch2/catch.hpp>

namespace roscell::test {

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
