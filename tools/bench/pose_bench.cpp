#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "skills/pose_estimation/pose_estimator.hpp"
#include "skills/vision/calibration.hpp"

#include <CLI/CLI.hpp>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

/// Times, frame by frame, of the skill pose_estimation beside those of the
/// AprilTag library alone on the same pixels with the same settings. The two
/// take turns, so that both meet the same state of the machine.
namespace {

using namespace roscell;
namespace fs = std::filesystem;
using clock_type = std::chrono::steady_clock;

struct settings {
  std::vector<std::string> folders;
  unsigned rounds = 20;
  float decimation = 2;
  int threads = 1;
};

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
  explicit bare_library(const settings& wanted)
      : family_(tag36h11_create(), tag36h11_destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    detector_->quad_decimate = wanted.decimation;
    detector_->nthreads = wanted.threads;
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
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
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

engine::environment make_environment(const settings& wanted) {
  engine::environment env;
  env.inputs = {
      {"ros2", "/image", ros2::sensor_msgs::image::type_name},
      {"ros2", "/camera_info", ros2::sensor_msgs::camera_info::type_name}};
  env.outputs = {{"ros2", "/tf", ros2::tf2_msgs::tf_message::type_name},
                 {"ros2", "/detections",
                  ros2::apriltag_msgs::april_tag_detection_array::type_name}};
  env.parameters = engine::parameters::parse(nlohmann::json{
      {"decimation", wanted.decimation},
      {"threads", wanted.threads}}.dump());
  return env;
}

/// The time that a share `q` of all frames did not exceed.
double quantile_ms(std::vector<clock_type::duration> times, double q) {
  auto rank =
      static_cast<std::ptrdiff_t>(q * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), times.begin() + rank, times.end());
  return std::chrono::duration<double, std::milli>{
      times[static_cast<std::size_t>(rank)]}
      .count();
}

template <class Work>
void measure(std::vector<clock_type::duration>& times, Work work) {
  auto start = clock_type::now();
  work();
  times.push_back(clock_type::now() - start);
}

void run_scene(const std::string& folder, const settings& wanted) {
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
  std::vector<clock_type::duration> of_skill;
  std::vector<clock_type::duration> of_library;
  auto tags = 0;
  for (auto round = 0U; round < wanted.rounds; ++round)
    for (auto& frame : frames) {
      engine::frame input;
      input.data_type = ros2::sensor_msgs::image::type_name;
      input.payload = frame.message;
      measure(of_library, [&] { tags = library.detect(frame.picture); });
      measure(of_skill, [&] { skill.process(input, output); });
    }
  auto skill_median = quantile_ms(of_skill, 0.5);
  auto library_median = quantile_ms(of_library, 0.5);
  std::cout << nlohmann::json{{"bench", "pose_estimation"},
                              {"scene", fs::path{folder}.filename().string()},
                              {"tags", tags},
                              {"frames", of_skill.size()},
                              {"decimation", wanted.decimation},
                              {"skill_median_ms", skill_median},
                              {"skill_p99_ms", quantile_ms(of_skill, 0.99)},
                              {"library_median_ms", library_median},
                              {"library_p99_ms", quantile_ms(of_library, 0.99)},
                              {"ratio", skill_median / library_median}}
            << std::endl;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Per-frame time of the skill pose_estimation (image message in, "
               "poses and detections out)\nbeside the AprilTag library's, as "
               "JSON lines."};
  settings wanted;
  app.option_defaults()->always_capture_default();
  app.add_option("SCENES", wanted.folders, "Folders of render_scenes")
      ->required();
  app.add_option("--rounds", wanted.rounds, "How often each frame is taken")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--decimation", wanted.decimation, "Of both")
      ->check(CLI::Range(1.0, 16.0));
  app.add_option("--threads", wanted.threads, "Of both")
      ->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  try {
    for (const auto& folder : wanted.folders)
      run_scene(folder, wanted);
  } catch (const std::exception& e) {
    std::cerr << "pose_bench: " << e.what() << '\n';
    return 1;
  }
}
