#pragma once

#include "actors/placement/search/problem.hpp"

#include <chrono>
#include <cstddef>

namespace roscell::allocation {

/// Counts the branches of a search and says when it must end.
class watch {
public:
  /// The budget runs from here. Keeps a reference to `given`.
  explicit watch(const limits& given) : given_(given) {
    if (given.budget.count() > 0)
      end_ = given.now() + given.budget;
  }

  /// Called before each branch. Once true, it stays true.
  bool must_stop() {
    ++branches_;
    stopped_ = stopped_ || (given_.cancelled && given_.cancelled())
               || (given_.budget.count() > 0 && given_.now() >= end_);
    return stopped_;
  }

  /// 0 means no limit.
  std::chrono::milliseconds budget() const {
    return given_.budget;
  }
  bool stopped() const {
    return stopped_;
  }
  std::size_t branches() const {
    return branches_;
  }

private:
  const limits& given_;
  std::chrono::steady_clock::time_point end_;
  std::size_t branches_ = 0;
  bool stopped_ = false;
};

} // namespace roscell::allocation
