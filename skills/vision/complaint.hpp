#pragma once

#include "roscell/skill/errors.hpp"
#include "roscell/skill/handlers.hpp"
#include "roscell/skill/parameters.hpp"

#include <strings.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

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

/// The encodings of images that a step takes, from its parameter `encodings`:
/// any, if it has none.
class accepted_encodings {
public:
  explicit accepted_encodings(const engine::parameters& options)
      : names_(options.texts("encodings", {}, 100)) {
    // nop
  }

  /// Throws engine::unusable_input.
  void check(const std::string& encoding) const {
    const auto is_it = [&](const std::string& x) {
      return strcasecmp(x.c_str(), encoding.c_str()) == 0;
    };
    if (!names_.empty() && std::none_of(names_.begin(), names_.end(), is_it))
      throw engine::unusable_input(
          "images in encoding '" + encoding
          + "', which is none of the parameter 'encodings'; have the camera "
            "send one of these, or add it there if skills/README.md lists it");
  }

private:
  const std::vector<std::string> names_;
};

} // namespace roscell::vision
