#include "skills/video/video_protocol.hpp"

#include "skills/video/video_input.hpp"

#include <opencv2/videoio.hpp>

#include <vector>

namespace roscell::video {

void add_video_protocol(engine::registry& target) {
  target.add_input("video", [](const engine::stream_context& input) {
    return std::make_unique<video_input>(input, make_capture);
  });
}

namespace {

/// Longer than any camera takes for a picture, shorter than a person waits for
/// a skill to stop.
constexpr auto patience_ms = 5000;

class capture : public picture_reader {
public:
  /// Devices are left to the kernel's interface, all else to FFmpeg, which
  /// alone can be told how long to wait.
  explicit capture(const std::string& endpoint) {
    if (endpoint.compare(0, 5, "/dev/") == 0)
      video_.open(endpoint, cv::CAP_V4L2);
    else
      video_.open(endpoint, cv::CAP_FFMPEG,
                  {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, patience_ms,
                   cv::CAP_PROP_READ_TIMEOUT_MSEC, patience_ms});
  }

  bool is_open() const {
    return video_.isOpened();
  }

  bool read(cv::Mat& target) override {
    return video_.read(target);
  }

private:
  cv::VideoCapture video_;
};

} // namespace

video_kind kind_of(const std::string& endpoint) {
  auto is_device = endpoint.compare(0, 5, "/dev/") == 0;
  auto is_url = endpoint.find("://") != std::string::npos;
  return is_device || is_url ? video_kind::camera : video_kind::file;
}

std::unique_ptr<picture_reader> make_capture(const std::string& endpoint) {
  auto result = std::make_unique<capture>(endpoint);
  if (!result->is_open())
    return nullptr;
  return result;
}

} // namespace roscell::video
