#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/diagnostic_msgs.hpp"
#include "roscell/ros2/nav_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/vision_msgs.hpp"

#include "bytes.hpp"

#include <catch2/catch.hpp>
#include <fastcdr/Cdr.h>

using namespace roscell;
using roscell::test::hex_of;

// Fast CDR writes the same fields, one by one as the definitions of ROS 2 have
// them: an implementation that shares nothing with ours but scalars.
namespace {

const ros2::std_msgs::header cam{{1, 2}, "cam"};
const std::vector<float> floats{1.5F, -2.0F, 3.25F};
const std::vector<double> doubles{0.5, -1.25};

class reference {
public:
  reference() {
    cdr_.serialize_encapsulation();
  }

  template <class... Fields>
  reference& add(const Fields&... fields) {
    (cdr_ << ... << fields);
    return *this;
  }

  reference& add_header() {
    return add(std::int32_t{1}, std::uint32_t{2}, std::string{"cam"});
  }

  std::string bytes() {
    return {memory_.data(), cdr_.getSerializedDataLength()};
  }

private:
  using Cdr = eprosima::fastcdr::Cdr;

  /// Zeros, for Fast CDR leaves padding as it finds it.
  std::string memory_ = std::string(4096, '\0');
  eprosima::fastcdr::FastBuffer buffer_{memory_.data(), memory_.size()};
  Cdr cdr_{buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
};

template <class T>
void check_same(const T& message, reference& expected) {
  auto bytes = expected.bytes();
  CHECK(hex_of(ros2::serialize(message)) == hex_of(bytes));
  CHECK(ros2::deserialize<T>(bytes) == message);
}

std::array<double, 36> covariance(double first) {
  std::array<double, 36> result{};
  result[0] = first;
  result[35] = -first;
  return result;
}

} // namespace

TEST_CASE("sensor_msgs/CompressedImage has the bytes of Fast CDR") {
  const std::vector<std::uint8_t> data{0xff, 0xd8, 0xff};
  check_same(ros2::sensor_msgs::compressed_image{cam, "jpeg", data},
             reference{}.add_header().add(std::string{"jpeg"}, data));
}

TEST_CASE("sensor_msgs/Imu has the bytes of Fast CDR") {
  ros2::sensor_msgs::imu x;
  x.header = cam;
  x.orientation = {1, 2, 3, 4};
  x.orientation_covariance[0] = -1;
  x.angular_velocity = {5, 6, 7};
  x.linear_acceleration = {8, 9, 10};
  x.linear_acceleration_covariance[8] = 11;
  std::array<double, 9> none{};
  auto first = none;
  first[0] = -1;
  auto last = none;
  last[8] = 11;
  check_same(x, reference{}
                    .add_header()
                    .add(1.0, 2.0, 3.0, 4.0, first, 5.0, 6.0, 7.0, none)
                    .add(8.0, 9.0, 10.0, last));
}

TEST_CASE("sensor_msgs/JointState has the bytes of Fast CDR") {
  const std::vector<std::string> names{"elbow", "hip"};
  check_same(ros2::sensor_msgs::joint_state{cam, names, doubles, {}, doubles},
             reference{}.add_header().add(names, doubles, std::vector<double>{},
                                          doubles));
}

TEST_CASE("sensor_msgs/LaserScan has the bytes of Fast CDR") {
  check_same(
      ros2::sensor_msgs::laser_scan{
          cam, -1, 1, 0.5F, 0.25F, 0.1F, 0.2F, 30, floats, {}},
      reference{}
          .add_header()
          .add(-1.0F, 1.0F, 0.5F, 0.25F, 0.1F, 0.2F, 30.0F)
          .add(floats, std::vector<float>{}));
}

TEST_CASE("sensor_msgs/PointCloud2 has the bytes of Fast CDR") {
  using ros2::sensor_msgs::point_field;
  const std::vector<std::uint8_t> data{1, 2, 3, 4, 5, 6, 7, 8};
  ros2::sensor_msgs::point_cloud2 x;
  x.header = cam;
  x.height = 1;
  x.width = 2;
  x.fields_ = {{"x", 0, point_field::FLOAT32, 1}, {"rgb", 4, 2, 3}};
  x.point_step = 4;
  x.row_step = 8;
  x.data = data;
  x.is_dense = true;
  using u8 = std::uint8_t;
  check_same(x, reference{}
                    .add_header()
                    .add(1U, 2U, 2U, std::string{"x"}, 0U, u8{7}, 1U)
                    .add(std::string{"rgb"}, 4U, u8{2}, 3U)
                    .add(false, 4U, 8U, data, true));
}

TEST_CASE("nav_msgs/Odometry has the bytes of Fast CDR") {
  ros2::nav_msgs::odometry x;
  x.header = cam;
  x.child_frame_id = "base";
  x.pose = {{{1, 2, 3}, {0, 0, 0, 1}}, covariance(4)};
  x.twist = {{{5, 6, 7}, {8, 9, 10}}, covariance(11)};
  check_same(x, reference{}
                    .add_header()
                    .add(std::string{"base"}, 1.0, 2.0, 3.0)
                    .add(0.0, 0.0, 0.0, 1.0, covariance(4))
                    .add(5.0, 6.0, 7.0, 8.0, 9.0, 10.0, covariance(11)));
}

TEST_CASE("nav_msgs/OccupancyGrid has the bytes of Fast CDR") {
  const std::vector<std::int8_t> cells{0, 100, -1};
  check_same(
      ros2::nav_msgs::occupancy_grid{
          cam, {{3, 4}, 0.05F, 3, 1, {{1, 2, 3}, {0, 0, 0, 1}}}, cells},
      reference{}
          .add_header()
          .add(std::int32_t{3}, 4U, 0.05F, 3U, 1U, 1.0, 2.0, 3.0)
          .add(0.0, 0.0, 0.0, 1.0, cells));
}

TEST_CASE("diagnostic_msgs/DiagnosticArray has the bytes of Fast CDR") {
  using ros2::diagnostic_msgs::diagnostic_status;
  diagnostic_status motor{
      diagnostic_status::WARN, "motor", "warm", "m1", {{"degrees", "81"}}};
  using text = std::string;
  check_same(ros2::diagnostic_msgs::diagnostic_array{cam, {motor}},
             reference{}
                 .add_header()
                 .add(1U, std::uint8_t{1}, text{"motor"}, text{"warm"})
                 .add(text{"m1"}, 1U, text{"degrees"}, text{"81"}));
}

TEST_CASE("vision_msgs/Detection2DArray has the bytes of Fast CDR") {
  ros2::vision_msgs::detection2_d found;
  found.header = cam;
  found.results.push_back({{"cup", 0.75}, {{{1, 2, 3}, {}}, covariance(4)}});
  found.bbox = {{{10, 20}, 0.5}, 30, 40};
  found.id = "7";
  using text = std::string;
  check_same(ros2::vision_msgs::detection2_d_array{cam, {found}},
             reference{}
                 .add_header()
                 .add(1U)
                 .add_header()
                 .add(1U, text{"cup"}, 0.75, 1.0, 2.0, 3.0)
                 .add(0.0, 0.0, 0.0, 1.0, covariance(4))
                 .add(10.0, 20.0, 0.5, 30.0, 40.0, text{"7"}));
}
