#pragma once

#include "roscell/skill/handlers.hpp"

#include <string>

namespace roscell::vision {

/// Says once what is wrong with a source of pictures, and once that it is well
/// again: the same problem comes with every picture. Of a source that changes
/// again and again it says no more after some lines.
class complaint {
public:
  /// `before` stands before what is wrong, e.g. "'/camera' is not rectified: ".
  complaint(std::string before, std::string cured, engine::say_function say)
      : before_(std::move(before)), cured_(std::move(cured)),
        say_(std::move(say)) {
    // nop
  }

  /// `problem` is empty when all is well.
  void update(const std::string& problem) {
    constexpr auto most_lines = 10;
    if (problem == said_)
      return;
    said_ = problem;
    if (lines_ == most_lines)
      return;
    ++lines_;
    say_((problem.empty() ? cured_ : before_ + problem)
         + (lines_ == most_lines
                ? "; it changes again and again, so no more is said of it"
                : ""));
  }

private:
  const std::string before_;
  const std::string cured_;
  const engine::say_function say_;
  std::string said_;
  int lines_ = 0;
};

} // namespace roscell::vision
