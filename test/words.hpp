#pragma once

#include <string>

namespace roscell::test {

/// Whether a text holds a part.
inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace roscell::test
