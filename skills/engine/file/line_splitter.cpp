#include "skills/engine/file/line_splitter.hpp"

namespace roscell::engine {

void line_splitter::feed(std::string_view bytes) {
  buffer_.erase(0, position_);
  searched_ -= position_;
  position_ = 0;
  // The head of a line that is already too long is not needed any more.
  if (buffer_.size() > max_bytes_) {
    buffer_.clear();
    searched_ = 0;
    skipping_ = true;
  }
  buffer_ += bytes;
}

std::optional<std::string> line_splitter::next() {
  for (;;) {
    auto end = buffer_.find('\n', searched_);
    if (end == std::string::npos) {
      searched_ = buffer_.size();
      return std::nullopt;
    }
    auto start = position_;
    position_ = searched_ = end + 1;
    if (accept(end - start))
      return buffer_.substr(start, end - start);
  }
}

std::optional<std::string> line_splitter::rest() {
  if (!has_rest())
    return std::nullopt;
  auto start = position_;
  position_ = searched_ = buffer_.size();
  if (!accept(buffer_.size() - start))
    return std::nullopt;
  return buffer_.substr(start);
}

bool line_splitter::accept(std::size_t size) {
  ++lines_;
  auto fits = !skipping_ && size <= max_bytes_;
  skipping_ = false;
  if (!fits)
    ++too_long_;
  return fits;
}

} // namespace roscell::engine
