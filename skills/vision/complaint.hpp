#pragma once

#include "roscell/skill/handlers.hpp"

#include <string>

namespace roscell::vision {

/// Says once what is wrong with a source of pictures, and once that it is well
/// again: the same trouble comes with every picture.
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
    if (problem == said_)
      return;
    say_(problem.empty() ? cured_ : before_ + problem);
    said_ = problem;
  }

private:
  const std::string before_;
  const std::string cured_;
  const engine::say_function say_;
  std::string said_;
};

} // namespace roscell::vision
