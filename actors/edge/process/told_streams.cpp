#include "actors/edge/process/told_streams.hpp"

#include "actors/edge/process/notification.hpp"

#include <algorithm>
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

std::optional<double> figure_of(std::string_view text) {
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
std::optional<stream_figure> read_stream(std::string_view text) {
  const auto end = take_until(text, ' ');
  const auto rate_hz = figure_of(take_until(text, ' '));
  const auto age_s = text == "-" ? std::optional<double>{-1} : figure_of(text);
  if (!names_end(end) || !rate_hz || !age_s)
    return std::nullopt;
  return stream_figure{std::string{end}, *rate_hz, *age_s};
}

} // namespace

std::vector<stream_figure> read_streams(std::string_view text) {
  std::vector<stream_figure> result;
  while (!text.empty()) {
    auto figure = read_stream(take_until(text, ';'));
    if (!figure || result.size() == max_told_streams)
      return {};
    result.push_back(std::move(*figure));
  }
  return result;
}

} // namespace roscell
