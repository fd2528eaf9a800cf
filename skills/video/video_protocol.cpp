#include "skills/video/video_protocol.hpp"

#include "skills/video/capture.hpp"
#include "skills/video/video_input.hpp"

namespace roscell::video {

void add_video_protocol(engine::registry& target) {
  target.add_input("video", [](const engine::stream_context& input) {
    return std::make_unique<video_input>(input, make_capture);
  });
}

} // namespace roscell::video
