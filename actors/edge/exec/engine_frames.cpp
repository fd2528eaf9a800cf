#include "actors/edge/exec/engine_frames.hpp"

#include <algorithm>
#include <charconv>

namespace roscell {

bool engine_frames::begin_frame() {
  const auto stream = static_cast<unsigned char>(head_[0]);
  if (stream > of_errors || head_[1] != 0 || head_[2] != 0 || head_[3] != 0)
    return false;
  errors_ = stream == of_errors;
  for (size_t i = 4; i < head_bytes; ++i)
    left_ = left_ * 256 + static_cast<unsigned char>(head_[i]);
  head_.clear();
  return true;
}

bool engine_frames::take(std::string_view bytes,
                         std::array<std::string, 2>& outputs) {
  while (!bytes.empty() && !broken_) {
    const bool in_frame = left_ > 0;
    const auto size =
        std::min(in_frame ? left_ : head_bytes - head_.size(), bytes.size());
    if (in_frame) {
      outputs[errors_ ? 1 : 0] += bytes.substr(0, size);
      left_ -= size;
    } else {
      head_ += bytes.substr(0, size);
      broken_ = head_.size() == head_bytes && !begin_frame();
    }
    bytes.remove_prefix(size);
  }
  return !broken_;
}

engine_answer_head read_answer_head(std::string_view bytes) {
  constexpr std::string_view end = "\r\n\r\n";
  constexpr std::string_view begin = "HTTP/1.";
  constexpr size_t status_place = begin.size() + 2;
  const auto size = bytes.find(end);
  if (size == std::string_view::npos)
    return {};
  engine_answer_head result;
  result.bytes = size + end.size();
  if (bytes.substr(0, begin.size()) == begin && size > status_place)
    std::from_chars(bytes.data() + status_place, bytes.data() + size,
                    result.status);
  return result;
}

} // namespace roscell
