#pragma once

#include "roscell/skill/errors.hpp"
#include "roscell/skill/parameters.hpp"

#include <algorithm>
#include <string>
#include <strings.h>
#include <vector>

namespace roscell::vision {

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
