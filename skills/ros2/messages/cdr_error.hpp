#pragma once

#include <stdexcept>
#include <string>

namespace roscell::ros2 {

/// Bytes that are no such message, or a message that cannot be written.
class cdr_error : public std::runtime_error {
public:
  /// `field` is the place, e.g. "detections[3].family".
  cdr_error(std::string field, std::string problem)
      : std::runtime_error("field '" + field + "': " + problem),
        field_(std::move(field)), problem_(std::move(problem)) {
    // nop
  }

  const std::string& field() const noexcept {
    return field_;
  }

  const std::string& problem() const noexcept {
    return problem_;
  }

private:
  std::string field_;
  std::string problem_;
};

} // namespace roscell::ros2
