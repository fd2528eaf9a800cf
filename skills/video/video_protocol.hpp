#pragma once

#include "roscell/skill/registry.hpp"

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

} // namespace roscell::video
