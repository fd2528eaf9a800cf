#include "actors/edge/io/node_time.hpp"

#include <array>
#include <cstdio>
#include <ctime>

namespace roscell {

namespace {

using calendar = std::tm* (*)(const std::time_t*, std::tm*);

std::string time_text(int64_t unix_ms, calendar to_parts, const char* form,
                      const char* zone) {
  auto seconds = static_cast<std::time_t>(unix_ms / 1000);
  auto millis = static_cast<int>(unix_ms % 1000);
  if (millis < 0) {
    millis += 1000;
    --seconds;
  }
  std::tm parts{};
  if (to_parts(&seconds, &parts) == nullptr)
    return "-";
  std::array<char, 64> buffer{};
  const auto n = std::strftime(buffer.data(), buffer.size(), form, &parts);
  std::snprintf(buffer.data() + n, buffer.size() - n, ".%03d%s", millis, zone);
  return buffer.data();
}

} // namespace

std::string iso_time(int64_t unix_ms) {
  return time_text(unix_ms, gmtime_r, "%FT%T", "Z");
}

std::string local_time(int64_t unix_ms) {
  return time_text(unix_ms, localtime_r, "%F %T", "");
}

} // namespace roscell
