#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace roscell {

/// Takes the two outputs of a command apart, which an engine sends as one
/// stream of frames: a byte that says which, three zeros, the size in network
/// byte order, and so many bytes. Keeps none of them.
class engine_frames {
public:
  /// Adds what has come to the outputs that it is of: the second are errors.
  /// False: it is no such stream.
  bool take(std::string_view bytes, std::array<std::string, 2>& outputs);

private:
  bool begin_frame();

  static constexpr size_t head_bytes = 8;
  static constexpr unsigned char of_errors = 2;

  std::string head_; ///< What has come of the next frame's.
  size_t left_ = 0;  ///< Of the frame that has begun.
  bool errors_ = false;
  bool broken_ = false;
};

/// What the head of an engine's answer to a request for a stream says.
struct engine_answer_head {
  int status = 0;   ///< 0: it is no HTTP.
  size_t bytes = 0; ///< Of the head; what follows is the stream, or an error.
};

/// Status 0 and no bytes as long as there is no whole head.
engine_answer_head read_answer_head(std::string_view bytes);

} // namespace roscell
