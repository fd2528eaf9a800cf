#include "skills/vision/calibration.hpp"

#include "roscell/skill/errors.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace roscell::vision {

namespace {

using engine::start_error;
namespace fs = std::filesystem;

/// Generous for a file of some forty numbers.
constexpr std::uintmax_t max_file_bytes = 65536;

std::string model_of(std::size_t coefficients) {
  return coefficients > 5 ? "rational_polynomial" : "plumb_bob";
}

void set_intrinsics(ros2::sensor_msgs::camera_info& info, double fx, double fy,
                    double cx, double cy) {
  info.k = {fx, 0, cx, 0, fy, cy, 0, 0, 1};
  info.r = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.p = {fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1, 0};
}

/// The numbers of `node`, which must be exactly `count` finite ones.
template <class Numbers>
void read_numbers(const YAML::Node& node, Numbers& numbers) {
  if (!node || node["data"].size() != numbers.size())
    throw std::runtime_error("must have 'data' of "
                             + std::to_string(numbers.size()) + " numbers");
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = node["data"][i].as<double>();
    if (!std::isfinite(numbers[i]))
      throw std::runtime_error("must have finite numbers");
  }
}

/// OpenCV's files begin with "%YAML:1.0", which is no directive of YAML.
std::string without_directive(const std::string& text) {
  if (text.compare(0, 6, "%YAML:") != 0)
    return text;
  const auto end = text.find('\n');
  return end == std::string::npos ? "" : text.substr(end);
}

/// Calls `read`, and lets what it throws name the place.
template <class Read>
void in_field(const char* name, Read read) {
  try {
    read();
  } catch (const std::exception& e) {
    throw std::runtime_error(std::string{"'"} + name + "' " + e.what());
  }
}

std::optional<std::string> find_file(const engine::stream& input,
                                     const engine::parameters& options) {
  auto named = options.text("camera_file", "");
  if (!named.empty() && fs::path{named}.is_absolute())
    return named;
  std::error_code error;
  if (input.protocol != "file" || !fs::is_directory(input.endpoint, error))
    return std::nullopt;
  auto folder = fs::path{input.endpoint};
  if (!named.empty())
    return (folder / named).string();
  for (const auto* name : {"camera.json", "camera.yaml", "camera_info.yaml"})
    if (fs::is_regular_file(folder / name, error))
      return (folder / name).string();
  return std::nullopt;
}

} // namespace

std::optional<ros2::sensor_msgs::camera_info>
calibration_of(const engine::parameters& options) {
  auto given = 0;
  for (const auto* name : {"fx", "fy", "cx", "cy"})
    given += options.has(name) ? 1 : 0;
  if (given == 0)
    return std::nullopt;
  if (given != 4)
    throw start_error("parameters 'fx', 'fy', 'cx' and 'cy' belong together: "
                      "give all four of them or none");
  constexpr auto far = 1e6;
  ros2::sensor_msgs::camera_info result;
  set_intrinsics(result, options.number("fx", 0, 1e-3, far),
                 options.number("fy", 0, 1e-3, far),
                 options.number("cx", 0, -far, far),
                 options.number("cy", 0, -far, far));
  result.d = options.numbers("distortion", {}, 14);
  result.distortion_model =
      options.text("distortion_model", model_of(result.d.size()));
  return result;
}

ros2::sensor_msgs::camera_info parse_calibration(const std::string& text) {
  auto document = YAML::Load(without_directive(text));
  if (!document.IsMap())
    throw std::runtime_error("is no calibration");
  ros2::sensor_msgs::camera_info result;
  in_field("image_width",
           [&] { result.width = document["image_width"].as<std::uint32_t>(); });
  in_field("image_height", [&] {
    result.height = document["image_height"].as<std::uint32_t>();
  });
  in_field("camera_matrix",
           [&] { read_numbers(document["camera_matrix"], result.k); });
  set_intrinsics(result, result.k[0], result.k[4], result.k[2], result.k[5]);
  if (auto node = document["distortion_coefficients"])
    in_field("distortion_coefficients", [&] {
      constexpr std::size_t most_coefficients = 32;
      result.d.resize(std::min(node["data"].size(), most_coefficients));
      read_numbers(node, result.d);
    });
  result.distortion_model =
      document["distortion_model"].as<std::string>(model_of(result.d.size()));
  if (auto node = document["rectification_matrix"])
    in_field("rectification_matrix", [&] { read_numbers(node, result.r); });
  if (auto node = document["projection_matrix"])
    in_field("projection_matrix", [&] { read_numbers(node, result.p); });
  return result;
}

ros2::sensor_msgs::camera_info read_calibration(const std::string& path) {
  std::error_code error;
  auto size = fs::file_size(path, error);
  if (error)
    throw start_error("cannot read camera file '" + path + "': "
                      + error.message() + "; see parameter 'camera_file'");
  if (size > max_file_bytes)
    throw start_error("camera file '" + path + "' is larger than "
                      + std::to_string(max_file_bytes)
                      + " bytes, so it is no calibration");
  std::ostringstream text;
  text << std::ifstream{path, std::ios::binary}.rdbuf();
  try {
    return parse_calibration(text.str());
  } catch (const std::exception& e) {
    throw start_error("camera file '" + path + "': " + e.what()
                      + "; write it as ROS's camera_calibration does");
  }
}

std::optional<ros2::sensor_msgs::camera_info>
calibration_beside(const engine::stream& input,
                   const engine::parameters& options) {
  auto path = find_file(input, options);
  if (!path)
    return std::nullopt;
  return read_calibration(*path);
}

} // namespace roscell::vision
