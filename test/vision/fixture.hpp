#pragma once

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/geometry_msgs.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/environment.hpp"
#include "roscell/skill/executor.hpp"
#include "roscell/skill/handlers.hpp"
#include "skills/vision/image_codec.hpp"
#include "tools/render_scenes/scene.hpp"

#include "test/parameters_of.hpp"
#include "test/places.hpp"
#include "test/skills/files.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

/// What stands around the skills that look at images in a test.
namespace roscell::test {

constexpr auto image_type = "sensor_msgs/msg/Image";
constexpr auto compressed_type = "sensor_msgs/msg/CompressedImage";
constexpr auto info_type = "sensor_msgs/msg/CameraInfo";
constexpr auto transforms_type = "tf2_msgs/msg/TFMessage";
constexpr auto detections_type = "apriltag_msgs/msg/AprilTagDetectionArray";
constexpr auto detections3d_type = "vision_msgs/msg/Detection3DArray";
constexpr auto lines_type = "application/json";
constexpr auto picture_type = "image/png";

/// A picture of the NASA Swarmathon with twelve tags, and their true corners.
const std::string photo_folder =
    test::source_dir() / "test/data/apriltag_photos";
const std::string photo = photo_folder + "/33369213973_9d9bb4cc96_c.jpg";
const std::string photo_truth = photo_folder + "/33369213973_9d9bb4cc96_c.txt";

/// Keeps all that an executor emits, by port, and why it gives nothing.
class collecting_emitter : public engine::emitter {
public:
  const std::vector<engine::frame>& of(std::size_t port) {
    return frames_[port];
  }

  const std::vector<std::string>& excuses() const {
    return excuses_;
  }

private:
  void write(engine::frame result, std::size_t port) override {
    frames_[port].push_back(std::move(result));
  }

  void explain(std::string reason) override {
    excuses_.push_back(std::move(reason));
  }

  std::map<std::size_t, std::vector<engine::frame>> frames_;
  std::vector<std::string> excuses_;
};

/// Keeps what is said to people.
class said_lines {
public:
  engine::say_function function() {
    return
        [lines = lines_](const std::string& line) { lines->push_back(line); };
  }

  const std::vector<std::string>& lines() const {
    return *lines_;
  }

private:
  std::shared_ptr<std::vector<std::string>> lines_ =
      std::make_shared<std::vector<std::string>>();
};

/// A step with inputs and outputs of these types, by protocol ros2.
engine::environment make_environment(const std::vector<std::string>& inputs,
                                     const std::vector<std::string>& outputs,
                                     const nlohmann::json& options);

/// A frame as the engine hands it to an executor.
engine::frame make_frame(std::size_t port, const std::string& type,
                         std::string payload, std::string name = "frame");

/// A scene in memory: true poses and one picture of them.
struct rendered_scene {
  scenes::scene_options options;
  std::vector<scenes::placed_tag> tags;
  vision::picture picture;

  /// The picture as sensor_msgs/msg/Image.
  std::string image() const;

  /// The camera as sensor_msgs/msg/CameraInfo.
  ros2::sensor_msgs::camera_info info() const;

  const scenes::placed_tag& tag(int id) const;
};

/// 640 x 480 pixels, as small scenes do for tests.
scenes::scene_options small_scene(unsigned tags, std::uint64_t seed = 1);

rendered_scene render(const scenes::scene_options& options);

/// The same with tags that are placed already.
rendered_scene render(const scenes::scene_options& options,
                      const std::vector<scenes::placed_tag>& tags);

/// The same small scene again and again; rendering it takes seconds under ASan.
const rendered_scene& four_tags();

/// How far a transform is from the true pose of a tag.
struct pose_difference {
  double distance_percent;
  double rotation_deg;
};

pose_difference difference(const ros2::geometry_msgs::transform& found,
                           const scenes::placed_tag& truth);

} // namespace roscell::test
