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

  /// The same error, seen from the field `outer` that this one is in.
  cdr_error inside(const std::string& outer) const {
    const auto* dot = field_.empty() || field_.front() == '[' ? "" : ".";
    return {outer + dot + field_, problem_};
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

/// Calls `f`, and lets the errors it throws name the place.
template <class F>
void in_field(const char* name, F&& f) {
  try {
    f();
  } catch (const cdr_error& e) {
    throw e.inside(name);
  }
}

} // namespace roscell::ros2
