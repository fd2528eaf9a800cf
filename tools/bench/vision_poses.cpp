#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/pose_estimation/tag_detector.hpp"
#include "skills/vision/calibration.hpp"
#include "tools/bench/vision_modes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace roscell::bench {

namespace {

namespace fs = std::filesystem;

/// A serialized image, and its pixels for the library.
struct test_frame {
  std::string message;
  vision::picture picture;
};

/// Forgets what a skill would write to a topic.
class discarding_emitter : public engine::emitter {
  void write(engine::frame, std::size_t) override {
    // Nothing is kept.
  }
};

/// AprilTag's own loop, without poses.
class bare_library {
public:
  explicit bare_library(const pose_options& wanted)
      : family_(pose::make_tag_family("tag36h11")),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    detector_->quad_decimate = wanted.decimation;
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), 0);
  }

  int detect(vision::picture& picture) {
    auto side = [](std::uint32_t n) { return static_cast<std::int32_t>(n); };
    image_u8_t image{side(picture.width), side(picture.height),
                     side(picture.width), picture.pixels.data()};
    auto* found = apriltag_detector_detect(detector_.get(), &image);
    auto count = zarray_size(found);
    apriltag_detections_destroy(found);
    return count;
  }

private:
  pose::tag_family family_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)>
      detector_;
};

std::vector<test_frame> load_frames(const std::string& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator{folder})
    if (entry.path().extension() == ".png")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<test_frame> result;
  for (const auto& path : paths) {
    std::ostringstream file;
    file << std::ifstream{path, std::ios::binary}.rdbuf();
    auto picture =
        vision::decode_picture(file.str(), vision::pixel_format::mono8);
    auto message = ros2::serialize(vision::view(picture, {{}, "camera"}));
    result.push_back({std::move(message), std::move(picture)});
  }
  if (result.empty())
    throw std::runtime_error("no .png in '" + folder + "'");
  return result;
}

engine::environment make_environment(const pose_options& wanted) {
  engine::environment env;
  env.inputs = {
      {"ros2", "/image", ros2::sensor_msgs::image::type_name},
      {"ros2", "/camera_info", ros2::sensor_msgs::camera_info::type_name}};
  env.outputs = {{"ros2", "/tf", ros2::tf2_msgs::tf_message::type_name},
                 {"ros2", "/detections",
                  ros2::apriltag_msgs::april_tag_detection_array::type_name}};
  env.parameters = engine::parameters::parse(
      nlohmann::json{{"decimation", wanted.decimation}}.dump());
  return env;
}

void compare_scene(const std::string& folder, const pose_options& wanted) {
  auto frames = load_frames(folder);
  pose::pose_estimator skill{make_environment(wanted)};
  discarding_emitter output;
  engine::frame info;
  info.port = 1;
  info.data_type = ros2::sensor_msgs::camera_info::type_name;
  info.payload =
      ros2::serialize(vision::read_calibration(folder + "/camera.json"));
  skill.process(info, output);
  bare_library library{wanted};
  std::vector<double> of_skill;
  std::vector<double> of_library;
  const auto wall = std::chrono::steady_clock::now;
  auto tags = 0;
  for (auto round = 0U; round < wanted.rounds; ++round)
    for (auto& frame : frames) {
      engine::frame input;
      input.data_type = ros2::sensor_msgs::image::type_name;
      input.payload = frame.message;
      measure(of_library, wall, [&] { tags = library.detect(frame.picture); });
      measure(of_skill, wall, [&] { skill.process(input, output); });
    }
  auto skill_median = quantile(of_skill, 0.5);
  auto library_median = quantile(of_library, 0.5);
  std::cout << nlohmann::json{{"bench", "pose_estimation"},
                              {"scene", fs::path{folder}.filename().string()},
                              {"tags", tags},
                              {"frames", of_skill.size()},
                              {"decimation", wanted.decimation},
                              {"skill_median_ms", skill_median},
                              {"skill_p99_ms", quantile(of_skill, 0.99)},
                              {"library_median_ms", library_median},
                              {"library_p99_ms", quantile(of_library, 0.99)},
                              {"ratio", skill_median / library_median}}
            << std::endl;
}

} // namespace

void compare_times_of_poses(const pose_options& options) {
  for (const auto& folder : options.scenes)
    compare_scene(folder, options);
}

} // namespace roscell::bench
