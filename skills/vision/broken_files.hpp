#pragma once

#include "roscell/skill/handlers.hpp"

#include <set>
#include <string>

namespace roscell::vision {

/// Says of each broken image file once that it is skipped: a folder that is
/// read in a loop brings it again and again.
class broken_files {
public:
  explicit broken_files(engine::say_function say) : say_(std::move(say)) {
    // nop
  }

  void skip(const std::string& name, const std::string& reason) {
    // Bounds the memory; after that many lines one more does not matter.
    constexpr std::size_t most_names = 1000;
    if (said_.size() >= most_names)
      said_.clear();
    if (said_.insert(name).second)
      say_("skipped '" + name + "': " + reason);
  }

private:
  const engine::say_function say_;
  std::set<std::string> said_;
};

} // namespace roscell::vision
