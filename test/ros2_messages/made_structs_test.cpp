#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/odd_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"

#include "bytes.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace roscell;
using ros2::odd_msgs::odd;
using roscell::test::bytes_of;
using roscell::test::hex_of;

namespace {

/// The error of writing a message, or "none".
std::string error_of(const odd& message) {
  try {
    ros2::serialize(message);
    return "none";
  } catch (const ros2::cdr_error& e) {
    return e.what();
  }
}

} // namespace

TEST_CASE("a made struct has the names, constants and defaults it is told") {
  CHECK(std::string{odd::type_name} == "odd_msgs/msg/Odd");
  CHECK(odd::FLAG == 16);
  CHECK(odd::LEAST == std::numeric_limits<std::int64_t>::min());
  CHECK(odd::MOST == std::numeric_limits<std::uint64_t>::max());
  CHECK(odd::HALF == 0.5F);
  CHECK(odd::YES);
  CHECK(odd::WORDS == std::string{"two \"words\""});
  CHECK(odd::BARE == std::string{"as it is"});
  odd x;
  CHECK(x.medium == -2);
  CHECK(x.few == std::vector<std::uint8_t>{1, 2});
  CHECK(x.words == std::array<std::string, 2>{"a", "b, c"});
  CHECK(x.flags == std::vector<bool>{true, false});
  CHECK(x.class_ == 5);
  CHECK(x.fields_ == 0);
  CHECK(ros2::geometry_msgs::quaternion{}.w == 1);
  CHECK(ros2::sensor_msgs::point_field::FLOAT32 == 7);
}

TEST_CASE("all kinds of fields lie where the rules of CDR put them") {
  // Alignment counts from behind the first four bytes.
  const auto bytes = bytes_of("00010000"
                              "01 00000000000000 000000000000f03f"
                              "02 00 feff 03000000 686900 00"
                              "02000000 0102 0000 02000000 6100 0000"
                              "05000000 622c206300 00 0000"
                              "02000000 0100 0000 00000000 00000000"
                              "0500000000000000 00000000");
  CHECK(hex_of(ros2::serialize(odd{})) == hex_of(bytes));
  CHECK(ros2::deserialize<odd>(bytes) == odd{});
}

TEST_CASE("a message without fields is one byte, as in ROS 2") {
  CHECK(hex_of(ros2::serialize(ros2::odd_msgs::empty{})) == "0001000000");
}

TEST_CASE("what is longer than its definition allows is not written") {
  odd x;
  x.few = {1, 2, 3, 4};
  CHECK(error_of(x) == "none");
  x.few.push_back(5);
  CHECK(error_of(x)
        == "field 'few': its 5 items are more than the 4 of its definition");
  x = {};
  x.text = "123456789";
  CHECK(error_of(x)
        == "field 'text': its 9 bytes are more than the 8 of its definition");
  x = {};
  x.words[1] = "12345";
  CHECK(error_of(x)
        == "field 'words': its 5 bytes are more than the 4 of its definition");
}

TEST_CASE("what is longer than its definition allows is not read") {
  // The text "hi" becomes one of nine bytes.
  const auto bytes = bytes_of("00010000"
                              "01 00000000000000 000000000000f03f"
                              "02 00 feff 0a000000 31323334353637383900 0000"
                              "02000000 0102 0000 02000000 6100 0000"
                              "05000000 622c206300 00 0000"
                              "02000000 0100 0000 00000000"
                              "0500000000000000 00000000");
  CHECK_THROWS_WITH(ros2::deserialize<odd>(bytes),
                    "field 'text': its 9 bytes are more than the 8 of its "
                    "definition");
}
