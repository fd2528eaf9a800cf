#include "actors/instances/ros2/ros_name.hpp"

#include <algorithm>

namespace roscell {

std::string ros_name(std::string_view text) {
  std::string result{text};
  std::replace_if(
      result.begin(), result.end(),
      [](char c) {
        return !((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
                 || (c >= '0' && c <= '9') || c == '_');
      },
      '_');
  const bool begins_badly =
      result.empty() || (result[0] >= '0' && result[0] <= '9');
  return begins_badly ? "_" + result : result;
}

} // namespace roscell
