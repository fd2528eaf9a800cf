#include "tools/roscell/doctor/node/camera_checks.hpp"

#include "roscell/ros2/cdr_error.hpp"
#include "roscell/ros2/image_encoding.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/skill/errors.hpp"
#include "skills/ros2/topic_listener.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/network/buffers.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"
#include "tools/roscell/ros2/echo/message_value.hpp"
#include "tools/roscell/ros2/found_topic.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>

namespace roscell::cli {

namespace {

using calibration = std::optional<std::vector<double>>;

/// What a camera says of its images, or the images say themselves.
struct camera_data {
  calibration k;
  sent_image image; ///< Of no bytes where it says nothing.
  std::optional<seen_image> seen;
};

/// A camera tells it with each image.
constexpr std::chrono::seconds camera_patience{3};

/// Each is a reader more in the cell for a moment.
constexpr size_t most_cameras = 8;

constexpr auto camera_info = "sensor_msgs/msg/CameraInfo";
constexpr auto image_message = "sensor_msgs/msg/Image";

camera_data data_of_info(const std::string& payload) {
  message_library library{{}};
  const auto value = message_value(library, camera_info, payload, 16);
  return {value.at("k").get<std::vector<double>>(),
          image_of(value.at("width").get<uint32_t>(),
                   value.at("height").get<uint32_t>()),
          {}};
}

camera_data data_of_image(const std::string& payload) {
  try {
    return {{}, {}, seen_image{ros2::view_image(payload).encoding, ""}};
  } catch (const ros2::cdr_error& e) {
    return {{}, {}, seen_image{"", e.what()}};
  }
}

/// One camera that is listened to.
class heard_camera {
public:
  heard_camera(const node_client& node, const topic_row& row) : row_{row} {
    const auto found = find_topic(node, row.topic);
    listener_ = std::make_unique<ros2::topic_listener>(
        found.config, row.topic, row.data_type, found.qos,
        [said = said_, is_image = is_image()](const ros2::heard_message& x) {
          hear(*said, is_image, x);
        });
  }

  camera_data answer(std::chrono::steady_clock::time_point deadline) {
    auto reported = said_->promise.get_future();
    const bool came =
        reported.wait_until(deadline) == std::future_status::ready;
    listener_.reset();
    return came ? reported.get() : camera_data{};
  }

  const topic_row& row() const {
    return row_;
  }

  bool is_image() const {
    return row_.data_type == image_message;
  }

private:
  struct first_word {
    std::promise<camera_data> promise;
    bool heard = false;
  };

  /// On a thread of Fast DDS, one call at a time.
  static void hear(first_word& said, bool is_image,
                   const ros2::heard_message& x) {
    if (std::exchange(said.heard, true))
      return;
    try {
      said.promise.set_value(is_image ? data_of_image(x.payload)
                                      : data_of_info(x.payload));
    } catch (const std::exception&) {
      said.promise.set_value({});
    }
  }

  topic_row row_;
  std::shared_ptr<first_word> said_ = std::make_shared<first_word>();
  std::unique_ptr<ros2::topic_listener> listener_;
};

/// At most so many of either type.
std::vector<topic_row> cameras_in(const topic_list& topics) {
  std::vector<topic_row> result;
  for (const auto* type : {camera_info, image_message}) {
    size_t count = 0;
    for (const auto& x : topics.topics)
      if (x.data_type == type && !x.writers.empty() && count++ < most_cameras)
        result.push_back(x);
  }
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
    const auto answer = x->answer(deadline);
    result.push_back(x->is_image() ? judge_images(x->row(), answer.seen)
                                   : judge_camera(x->row(), answer.k));
    if (answer.image.bytes > largest.bytes)
      largest = answer.image;
  }
  // `buffers` does not know what flows.
  const auto given = read_buffers();
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

finding judge_images(const topic_row& topic,
                     const std::optional<seen_image>& seen) {
  const auto echo = "roscell echo " + shell_word(topic.topic) + " --count 1";
  if (!seen)
    return {judgement::skipped,
            "no image came on " + topic.topic + " within "
                + std::to_string(camera_patience.count()) + " s",
            "its writer is waiting for pictures, or cannot be heard from here",
            echo};
  const auto how =
      topic.readers.empty() ? judgement::warning : judgement::broken;
  if (!seen->fault.empty())
    return {
        how, topic.topic + " has images whose sizes lie: " + seen->fault,
        "skills that read it refuse each of them: correct the driver of the "
        "camera",
        echo};
  const auto encoding = ros2::find_encoding(seen->encoding);
  if (encoding && encoding->is_picture())
    return {judgement::ok,
            topic.topic + " has images in encoding " + seen->encoding};
  return {how,
          topic.topic + " has images in encoding '" + seen->encoding
              + "', of which "
              + (encoding ? "nothing says how bright a pixel is"
                          : "nothing is known"),
          "pose_estimation and convert end when they read it: have the camera "
          "send gray, colours, Bayer or YUV",
          echo};
}

findings check_cameras(const node_client& node) {
  try {
    const auto cameras = cameras_in(node.get("/v1/topics").get<topic_list>());
    if (cameras.empty())
      return {{judgement::ok, "no camera publishes anything"}};
    return listen_to(node, cameras);
  } catch (const engine::start_error& e) {
    return {{judgement::skipped, e.what()}};
  } catch (const std::exception& e) {
    return {finding_of_failure(e, judgement::skipped)};
  }
}

} // namespace roscell::cli
