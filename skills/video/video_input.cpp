#include "skills/video/video_input.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/pacer.hpp"

#include <opencv2/imgproc.hpp>

namespace roscell::video {

namespace {

bool wants_gray(const engine::parameters& options) {
  auto encoding = options.text("encoding", "mono8");
  if (encoding != "mono8" && encoding != "bgr8")
    throw engine::start_error("parameter 'encoding' is '" + encoding
                              + "', but must be mono8 or bgr8");
  return encoding == "mono8";
}

/// Gives the picture one or three channels.
cv::Mat convert(const cv::Mat& picture, bool gray) {
  cv::Mat result = picture;
  if (gray && picture.channels() == 3)
    cv::cvtColor(picture, result, cv::COLOR_BGR2GRAY);
  if (!gray && picture.channels() == 1)
    cv::cvtColor(picture, result, cv::COLOR_GRAY2BGR);
  return result.isContinuous() ? result : result.clone();
}

} // namespace

video_input::video_input(const engine::stream_context& input, open_reader open)
    : endpoint_(input.config.endpoint), kind_(kind_of(endpoint_)),
      gray_(wants_gray(input.options)),
      loop_(input.options.flag("loop", false) && kind_ == video_kind::file),
      rate_hz_(input.options.number("rate_hz", 0, 0, 1'000'000)),
      frame_id_(input.options.text("frame_id", "camera")),
      open_(std::move(open)) {
  if (kind_ == video_kind::file && endpoint_.front() != '/')
    throw engine::start_error(
        "video endpoint '" + endpoint_
        + "' must be a camera like /dev/video0, the absolute path of a file, "
          "or a URL; correct it in the step");
}

void video_input::open() {
  reader_ = open_(endpoint_);
  if (!reader_)
    throw engine::start_error("cannot open " + what()
                              + "; it must be there on the node that runs this "
                                "step, free, and readable");
}

void video_input::run(engine::frame_sink& sink,
                      const engine::stop_event& stop) {
  while (push_all(sink, stop)) {
    if (kind_ == video_kind::camera)
      throw engine::stream_error(what()
                                 + " gives no more pictures; see whether it is "
                                   "still connected");
    if (count_ == 0)
      throw engine::stream_error(what()
                                 + " holds no picture that can be "
                                   "decoded");
    if (!loop_)
      return;
    open();
  }
}

/// Returns false when the skill stops, true when no more pictures come.
bool video_input::push_all(engine::frame_sink& sink,
                           const engine::stop_event& stop) {
  engine::pacer pace{rate_hz_};
  cv::Mat picture;
  while (!stop.is_set() && reader_->read(picture)) {
    // A camera that is made to wait would give old pictures from then on.
    if (kind_ == video_kind::camera && !pace.take_turn())
      continue;
    if (kind_ == video_kind::file && !pace.wait(stop))
      return false;
    if (!sink.push(make_frame(picture), policy()))
      return false;
  }
  return !stop.is_set();
}

engine::frame video_input::make_frame(const cv::Mat& picture) {
  auto pixels = convert(picture, gray_);
  engine::frame result;
  result.time = std::chrono::system_clock::now();
  result.data_type = ros2::sensor_msgs::image::type_name;
  result.name = std::to_string(count_++);
  ros2::image_view view;
  view.header = {ros2::to_time(result.time), frame_id_};
  view.height = static_cast<std::uint32_t>(pixels.rows);
  view.width = static_cast<std::uint32_t>(pixels.cols);
  view.encoding = gray_ ? "mono8" : "bgr8";
  view.step = static_cast<std::uint32_t>(pixels.step);
  view.data = pixels.data;
  view.size = pixels.total() * pixels.elemSize();
  result.payload = ros2::serialize(view);
  return result;
}

engine::when_full video_input::policy() const {
  return kind_ == video_kind::file ? engine::when_full::wait
                                   : engine::when_full::drop_oldest;
}

std::string video_input::what() const {
  return (kind_ == video_kind::file ? "video file '" : "camera '") + endpoint_
         + "'";
}

} // namespace roscell::video
