#include "actors/edge/process/reported_streams.hpp"

#include "actors/edge/process/notification.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace roscell {

namespace {

/// Takes the text before the next `mark`, or all of it, off the front.
std::string_view take_until(std::string_view& text, char mark) {
  const auto end = text.find(mark);
  const auto result = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return result;
}

std::optional<double> parsed_number(std::string_view text) {
  double value = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] =
      std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (error != std::errc{} || rest != end || !std::isfinite(value)
      || std::signbit(value))
    return std::nullopt;
  return value;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool names_end(std::string_view text) {
  auto number = text;
  const auto direction = take_until(number, ':');
  return (direction == "input" || direction == "output") && !number.empty()
         && number.size() <= 2
         && std::all_of(number.begin(), number.end(), is_digit);
}

/// "input:0 12.5 0.040"
std::optional<stream_metrics> read_stream(std::string_view text) {
  const auto end = take_until(text, ' ');
  const auto rate_hz = parsed_number(take_until(text, ' '));
  const auto age_s =
      text == "-" ? std::optional<double>{-1} : parsed_number(text);
  if (!names_end(end) || !rate_hz || !age_s)
    return std::nullopt;
  return stream_metrics{std::string{end}, *rate_hz, *age_s};
}

/// The numbers that follow in `text`, if these are as many as wanted.
template <size_t Wanted>
std::optional<std::array<int64_t, Wanted>> counts_in(std::string_view text) {
  // The largest that JSON carries exactly.
  constexpr int64_t most = 9'007'199'254'740'991;
  std::array<int64_t, Wanted> result{};
  for (auto& value : result) {
    const auto word = take_until(text, ' ');
    const auto* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc{} || rest != end || value < 0 || value > most)
      return std::nullopt;
  }
  return text.empty() ? std::optional{result} : std::nullopt;
}

/// "input:0 118 115 3 0 850", "output:0 115"
std::optional<stream_count> read_count(std::string_view text) {
  constexpr double us_in_ms = 1000;
  constexpr double most_ms = 1e9;
  stream_count result;
  result.end = take_until(text, ' ');
  if (!names_end(result.end))
    return std::nullopt;
  if (result.end[0] == 'o') {
    const auto written = counts_in<1>(text);
    if (!written)
      return std::nullopt;
    result.frames = written->front();
    return result;
  }
  const auto reported = counts_in<5>(text);
  if (!reported)
    return std::nullopt;
  result.frames = (*reported)[0];
  result.processed = (*reported)[1];
  result.failed = (*reported)[2];
  result.dropped = (*reported)[3];
  // A median of no frames is none.
  if (result.processed > 0)
    result.latency_ms =
        std::min(static_cast<double>((*reported)[4]) / us_in_ms, most_ms);
  return result;
}

/// All parts of a line, or none.
template <class T>
std::vector<T> read_all(std::string_view text,
                        std::optional<T> (*read)(std::string_view)) {
  std::vector<T> result;
  while (!text.empty()) {
    auto part = read(take_until(text, ';'));
    if (!part || result.size() == max_reported_streams)
      return {};
    result.push_back(std::move(*part));
  }
  return result;
}

} // namespace

std::vector<stream_metrics> read_streams(std::string_view text) {
  return read_all(text, read_stream);
}

std::vector<stream_count> read_frames(std::string_view text) {
  return read_all(text, read_count);
}

} // namespace roscell
