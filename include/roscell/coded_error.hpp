#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace roscell {

/// What could not be done, in words, with a code for programs.
class coded_error : public std::runtime_error {
public:
  coded_error(std::string code, const std::string& message, std::string hint)
      : std::runtime_error{message}, code_(std::move(code)),
        hint_(std::move(hint)) {}

  /// A word of docs/protocols.md, such as "conflict".
  const std::string& code() const noexcept {
    return code_;
  }

  /// What to do about it, or empty.
  const std::string& hint() const noexcept {
    return hint_;
  }

private:
  std::string code_;
  std::string hint_;
};

} // namespace roscell
