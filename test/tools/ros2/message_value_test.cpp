#include "tools/roscell/ros2/echo/message_value.hpp"

#include <catch2/catch.hpp>

#include <unistd.h>

#include <fstream>

using namespace roscell;
using namespace roscell::cli;
using Catch::Matchers::Contains;

namespace {

/// Little-endian, as its encapsulation says.
std::string cdr(const std::string& body) {
  return std::string{"\0\1\0\0", 4} + body;
}

std::string bytes(std::initializer_list<int> values) {
  std::string result;
  for (const int x : values)
    result += static_cast<char>(x);
  return result;
}

std::string shown(const std::string& type, const std::string& payload,
                  std::size_t most_items = 4) {
  message_library library{{}};
  return value_text(message_value(library, type, payload, most_items));
}

} // namespace

TEST_CASE("a definition has fields; constants, defaults, bounds and comments "
          "are none",
          "[tools]") {
  const auto fields = read_definition("demo_msgs", R"(# A comment.
uint8 RED = 1
uint8 GREEN=2
Header header
string<=10 label "none"   # why
float64[9] matrix
geometry_msgs/Point[<=3] corners
Part[] parts
)");
  REQUIRE(fields.size() == 5);
  CHECK(fields[0].type == "std_msgs/msg/Header");
  CHECK(fields[1].type == "string");
  CHECK_FALSE(fields[1].is_array);
  CHECK(fields[2].items == 9);
  CHECK(fields[3].type == "geometry_msgs/msg/Point");
  CHECK(fields[3].is_array);
  CHECK(fields[3].items == 0);
  CHECK(fields[4].type == "demo_msgs/msg/Part");
}

TEST_CASE("a line that is no field is named", "[tools]") {
  CHECK_THROWS_WITH(read_definition("p", "int8 a\nint8\n"),
                    "line 2: 'int8' has no name");
  CHECK_THROWS_WITH(read_definition("p", "int8[99999999] a"),
                    Contains("too long"));
}

TEST_CASE("a message is shown by its definition, with alignment kept",
          "[tools]") {
  // A std_msgs/Header: two times, then a text with its length.
  const auto header =
      cdr(bytes({1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 'm', 'a', 'p', 0}));
  CHECK(shown("std_msgs/msg/Header", header)
        == "stamp:\n  sec: 1\n  nanosec: 2\nframe_id: \"map\"\n");
}

TEST_CASE("of a long sequence the rest is counted", "[tools]") {
  const auto image = cdr(
      bytes({0, 0, 0, 0, 0,   0,   0,   0,   1,   0, 0, 0, 0, 0, 0, 0, // header
             2, 0, 0, 0, 3,   0,   0,   0,                             // 2 x 3
             6, 0, 0, 0, 'm', 'o', 'n', 'o', '8', 0, // encoding
             0, 0, 3, 0, 0,   0,   6,   0,   0,   0, 1, 2, 3, 4, 5, 6}));
  CHECK_THAT(shown("sensor_msgs/msg/Image", image),
             Contains("data: [1, 2, 3, 4, ... 6 in all]\n"));
  CHECK_THAT(shown("sensor_msgs/msg/Image", image, 6),
             Contains("data: [1, 2, 3, 4, 5, 6]\n"));
}

TEST_CASE("bytes that are no such message are refused", "[tools]") {
  CHECK_THROWS_AS(shown("std_msgs/msg/String", cdr("")), definition_error);
  CHECK_THROWS_AS(
      shown("std_msgs/msg/String", cdr(bytes({255, 255, 255, 127, 'x'}))),
      definition_error);
  CHECK_THROWS_AS(shown("tf2_msgs/msg/TFMessage",
                        cdr(bytes({255, 255, 255, 255, 0, 0, 0, 0}))),
                  definition_error);
  CHECK_THROWS_AS(shown("std_msgs/msg/String", "x"), definition_error);
}

TEST_CASE("a type that is not known is named, with the remedy", "[tools]") {
  CHECK_THROWS_WITH(shown("demo_msgs/msg/Own", cdr("")),
                    Contains("demo_msgs/msg/Own")
                        && Contains("AMENT_PREFIX_PATH"));
}

TEST_CASE("types of installed workspaces are known", "[tools]") {
  namespace fs = std::filesystem;
  const auto workspace = fs::temp_directory_path()
                         / ("roscell-echo-" + std::to_string(::getpid()));
  fs::create_directories(workspace / "share/demo_msgs/msg");
  std::ofstream{workspace / "share/demo_msgs/msg/Own.msg"}
      << "uint8 level\nOwn[] more\n";
  message_library library{{workspace}};
  CHECK(value_text(message_value(library, "demo_msgs/msg/Own",
                                 cdr(bytes({7, 0, 0, 0, 0, 0, 0, 0})), 4))
        == "level: 7\nmore: []\n");
  fs::remove_all(workspace);
}
