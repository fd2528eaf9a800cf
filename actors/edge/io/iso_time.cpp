#include "actors/edge/io/iso_time.hpp"

#include <array>
#include <cstdio>
#include <ctime>

namespace roscell {

std::string iso_time(int64_t unix_ms) {
  auto seconds = static_cast<std::time_t>(unix_ms / 1000);
  auto millis = static_cast<int>(unix_ms % 1000);
  if (millis < 0) {
    millis += 1000;
    --seconds;
  }
  std::tm parts{};
  if (gmtime_r(&seconds, &parts) == nullptr)
    return "-";
  std::array<char, 64> buffer{};
  const auto n = std::strftime(buffer.data(), buffer.size(), "%FT%T", &parts);
  std::snprintf(buffer.data() + n, buffer.size() - n, ".%03dZ", millis);
  return buffer.data();
}

} // namespace roscell
