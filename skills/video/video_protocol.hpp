#pragma once

#include "roscell/skill/registry.hpp"

#include <opencv2/core.hpp>

#include <functional>
#include <memory>
#include <string>

namespace roscell::video {

/// Adds the input protocol `video`. An endpoint is a camera (/dev/video0), the
/// absolute path of a video file, or the URL of a network camera (rtsp://,
/// http://, https://). Each picture is one frame whose payload is a serialized
/// sensor_msgs/msg/Image, stamped when it was taken out of the video.
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | encoding | mono8 | of the pictures: mono8 or bgr8 |
/// | frame_id | camera | frame that the pictures are taken in |
/// | rate_hz | 0 | most frames per second; 0 is no limit: a file as fast as
///   the executor takes it, a camera as it comes |
/// | loop | false | a file begins again at its end, until stopped |
///
/// The end of a file ends the input. A camera has no end: when it gives no more
/// pictures the input breaks, and the skill with it.
void add_video_protocol(engine::registry& target);

enum class video_kind {
  file,   ///< Has an end.
  camera, ///< Has none.
};

/// What an endpoint of the protocol is, by its form.
video_kind kind_of(const std::string& endpoint);

/// Takes one picture after the other out of a video.
class picture_reader {
public:
  virtual ~picture_reader() = default;

  /// Waits for the next picture, at most some seconds, and puts it into
  /// `target`: 8 bits, one channel or three in the order of bgr8. Returns false
  /// when none comes any more.
  virtual bool read(cv::Mat& target) = 0;
};

/// Opens a video. Returns nullptr when that is impossible.
using open_reader =
    std::function<std::unique_ptr<picture_reader>(const std::string& endpoint)>;

/// Opens a camera, file or URL by OpenCV.
std::unique_ptr<picture_reader> make_capture(const std::string& endpoint);

} // namespace roscell::video
