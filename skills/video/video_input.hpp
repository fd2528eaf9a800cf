#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/video/video_protocol.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace roscell::video {

/// Reads a video on the input's own thread, where waiting for a camera blocks
/// nobody else. See video_protocol.hpp.
class video_input : public engine::input_handler {
public:
  /// Throws start_error when the endpoint or a parameter makes no sense.
  video_input(const engine::stream_context& input, open_reader open);

  /// Throws start_error when the video cannot be opened.
  void open() override;

  /// Throws stream_error when a camera vanishes, or a file holds no picture.
  void run(engine::frame_sink& sink, const engine::stop_event& stop) override;

  bool survives_new_address() const override {
    return true;
  }

private:
  bool push_all(engine::frame_sink& sink, const engine::stop_event& stop);
  engine::frame make_frame(const cv::Mat& picture);
  engine::when_full policy() const;
  std::string what() const;

  const std::string endpoint_;
  const video_kind kind_;
  const bool gray_;
  const bool loop_;
  const double rate_hz_;
  const std::string frame_id_;
  const open_reader open_;
  std::unique_ptr<picture_reader> reader_;
  std::uint64_t count_ = 0;
};

} // namespace roscell::video
