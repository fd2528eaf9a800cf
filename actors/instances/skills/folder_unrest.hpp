#pragma once

#include "actors/instances/limits.hpp"

#include <algorithm>
#include <chrono>
#include <optional>

namespace roscell {

/// When folders in which something changes are to be read. Pure; told the time.
///
///     [*] -- touched --> restless
///     restless -- quiet for `limits::skill::quiet` --> read --> [*]
///     restless -- touched for `longest_unrest` without that --> read, while it
///                 goes on --> restless
class folder_unrest {
public:
  using time_point = std::chrono::steady_clock::time_point;

  void touch(time_point now) {
    if (!since_)
      since_ = now;
    last_ = now;
  }

  /// When the folders are to be read; max(): nothing has changed.
  time_point due() const {
    return since_ ? std::min(last_ + limits::skill::quiet,
                             *since_ + limits::skill::longest_unrest)
                  : time_point::max();
  }

  /// They are about to be read. Gives whether nobody writes there any more.
  bool begin_reading(time_point now) {
    const bool is_quiet = now >= last_ + limits::skill::quiet;
    since_ = is_quiet ? std::nullopt : std::optional{now};
    return is_quiet;
  }

private:
  std::optional<time_point> since_; ///< None: they are at rest.
  time_point last_;
};

} // namespace roscell
