#include "tools/roscell/doctor/node/camera_checks.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/network/buffers.hpp"
#include "tools/roscell/doctor/node/answer_trouble.hpp"
#include "tools/roscell/ros2/echo/message_value.hpp"
#include "tools/roscell/ros2/found_topic.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>

namespace roscell::cli {

namespace {

using calibration = std::optional<std::vector<double>>;

/// What a camera says of its images.
struct camera_words {
  calibration k;
  sent_image image; ///< Of no bytes where it says nothing.
};

/// A camera tells it with each image.
constexpr std::chrono::seconds camera_patience{3};

/// Each is a reader more in the cell for a moment.
constexpr size_t most_cameras = 8;

constexpr auto camera_info = "sensor_msgs/msg/CameraInfo";

/// One camera that is listened to.
class heard_camera {
public:
  heard_camera(const node_client& node, const topic_row& row) : row_{row} {
    const auto found = find_topic(node, row.topic);
    listener_ = std::make_unique<ros2::topic_listener>(
        found.config, row.topic, row.data_type, found.qos,
        [said = said_](const ros2::heard_message& x) { hear(*said, x); });
  }

  camera_words words(std::chrono::steady_clock::time_point deadline) {
    auto told = said_->promise.get_future();
    const bool came = told.wait_until(deadline) == std::future_status::ready;
    listener_.reset();
    return came ? told.get() : camera_words{};
  }

  const topic_row& row() const {
    return row_;
  }

private:
  struct first_word {
    std::promise<camera_words> promise;
    bool heard = false;
  };

  /// On a thread of Fast DDS, one call at a time.
  static void hear(first_word& said, const ros2::heard_message& x) {
    if (std::exchange(said.heard, true))
      return;
    try {
      message_library library{{}};
      const auto value = message_value(library, camera_info, x.payload, 16);
      said.promise.set_value({value.at("k").get<std::vector<double>>(),
                              image_of(value.at("width").get<uint32_t>(),
                                       value.at("height").get<uint32_t>())});
    } catch (const std::exception&) {
      said.promise.set_value({});
    }
  }

  topic_row row_;
  std::shared_ptr<first_word> said_ = std::make_shared<first_word>();
  std::unique_ptr<ros2::topic_listener> listener_;
};

std::vector<topic_row> cameras_in(const topic_list& topics) {
  std::vector<topic_row> result;
  for (const auto& x : topics.topics)
    if (x.data_type == camera_info && !x.writers.empty()
        && result.size() < most_cameras)
      result.push_back(x);
  return result;
}

findings listen_to(const node_client& node,
                   const std::vector<topic_row>& cameras) {
  std::vector<std::unique_ptr<heard_camera>> heard;
  heard.reserve(cameras.size());
  for (const auto& x : cameras)
    heard.push_back(std::make_unique<heard_camera>(node, x));
  const auto deadline = std::chrono::steady_clock::now() + camera_patience;
  findings result;
  sent_image largest;
  for (const auto& x : heard) {
    const auto words = x->words(deadline);
    result.push_back(judge_camera(x->row(), words.k));
    if (words.image.bytes > largest.bytes)
      largest = words.image;
  }
  // `buffers` does not know what flows.
  const auto given = look_at_buffers();
  if (std::min(given.receive, given.send) < largest.bytes)
    result.push_back(judge_buffers(given, largest));
  return result;
}

} // namespace

finding judge_camera(const topic_row& topic, const calibration& k) {
  if (!k)
    return {judgement::skipped,
            "nothing came on " + topic.topic + " within "
                + std::to_string(camera_patience.count()) + " s",
            "its writer is waiting for pictures, or cannot be heard from here",
            "roscell echo " + shell_word(topic.topic) + " --count 1"};
  if (std::any_of(k->begin(), k->end(), [](double x) { return x != 0; }))
    return {judgement::ok, topic.topic + " tells a calibration"};
  return {
      topic.readers.empty() ? judgement::warning : judgement::broken,
      topic.topic + " is all zero: its camera is not calibrated",
      "nothing can be measured in its pictures: skills that read it refuse "
      "them, or compute nonsense",
      "ros2 run camera_calibration cameracalibrator --size 8x6 --square "
      "0.025 --ros-args -r "
          + shell_word("image:=" + topic.topic.substr(0, topic.topic.rfind('/'))
                       + "/image")};
}

findings examine_cameras(const node_client& node) {
  try {
    const auto cameras = cameras_in(node.get("/v1/topics").get<topic_list>());
    if (cameras.empty())
      return {{judgement::ok, "no camera tells anything"}};
    return listen_to(node, cameras);
  } catch (const engine::start_error& e) {
    return {{judgement::skipped, e.what()}};
  } catch (const std::exception& e) {
    return {trouble_of(e, judgement::skipped)};
  }
}

} // namespace roscell::cli
