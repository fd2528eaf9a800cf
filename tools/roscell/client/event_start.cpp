#include "tools/roscell/client/event_start.hpp"

#include "tools/roscell/view/span.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace {

constexpr int64_t ms_per_second = 1000;
constexpr int64_t seconds_per_day = 24 * 3600;

std::optional<uint64_t> whole_number(std::string_view text) {
  uint64_t result = 0;
  const auto [rest, error] =
      std::from_chars(text.data(), text.data() + text.size(), result);
  if (error != std::errc{} || rest != text.data() + text.size())
    return std::nullopt;
  return result;
}

std::optional<std::chrono::seconds> span_before(std::string_view text) {
  try {
    return parse_span(text);
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// All of `text` in the form `format` of strptime.
std::optional<std::tm> parsed_as(const std::string& text, const char* format,
                                 const std::tm& unless_said) {
  auto result = unless_said;
  const auto* rest = ::strptime(text.c_str(), format, &result);
  if (rest == nullptr || *rest != '\0')
    return std::nullopt;
  return result;
}

/// Seconds since 1970 of what a clock on the wall shows here.
int64_t local_seconds(std::tm shown) {
  shown.tm_isdst = -1;
  return static_cast<int64_t>(std::mktime(&shown));
}

std::optional<int64_t> moment_of(std::string text, int64_t now_s) {
  const bool is_utc = !text.empty() && text.back() == 'Z';
  if (is_utc)
    text.pop_back();
  const std::tm midnight{};
  for (const auto* format : {"%Y-%m-%d", "%Y-%m-%d %H:%M", "%Y-%m-%dT%H:%M",
                             "%Y-%m-%d %H:%M:%S", "%Y-%m-%dT%H:%M:%S"})
    if (auto shown = parsed_as(text, format, midnight))
      return is_utc ? static_cast<int64_t>(::timegm(&*shown))
                    : local_seconds(*shown);
  const auto now = static_cast<std::time_t>(now_s);
  std::tm today{};
  ::localtime_r(&now, &today);
  today.tm_sec = 0;
  if (const auto shown = parsed_as(text, "%H:%M", today); shown && !is_utc) {
    const auto result = local_seconds(*shown);
    return result > now_s ? result - seconds_per_day : result;
  }
  return std::nullopt;
}

} // namespace

event_start parse_event_start(const std::string& text, int64_t now_unix_ms) {
  if (text == "start")
    return {};
  if (const auto number = whole_number(text))
    return {*number, 0, *number > 0};
  if (const auto span = span_before(text))
    return {0,
            std::max<int64_t>(1, now_unix_ms - span->count() * ms_per_second)};
  if (const auto moment = moment_of(text, now_unix_ms / ms_per_second))
    return {0, std::max<int64_t>(1, *moment * ms_per_second)};
  throw std::invalid_argument{
      "'" + text
      + "' is neither the number of an event, nor a span such as 2h or 7d, nor "
        "a moment such as 08:00 or '2026-11-25 08:00', nor start"};
}

} // namespace roscell::cli
