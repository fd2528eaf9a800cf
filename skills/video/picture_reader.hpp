#pragma once

#include <opencv2/core.hpp>

#include <functional>
#include <memory>
#include <string>

namespace roscell::video {

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

} // namespace roscell::video
