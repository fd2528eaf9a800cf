#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

namespace roscell::cli {

namespace {

/// A code point, and its bytes in UTF-8; 0 bytes if `text` begins with none.
struct decoded {
  uint32_t point = 0;
  size_t length = 0;
};

decoded decode_first(std::string_view text) {
  const auto byte = [&](size_t i) {
    return static_cast<unsigned char>(text[i]);
  };
  const auto first = byte(0);
  if (first < 0x80)
    return {first, 1};
  const size_t n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < n)
    return {};
  uint32_t point = first & (0xffU >> (n + 1));
  for (size_t i = 1; i < n; ++i) {
    if ((byte(i) & 0xc0) != 0x80)
      return {};
    point = point << 6 | (byte(i) & 0x3fU);
  }
  constexpr std::array<uint32_t, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  const bool bad = point < smallest[n] || point > 0x10ffff
                   || (point >= 0xd800 && point < 0xe000);
  return bad ? decoded{} : decoded{point, n};
}

/// Whether a terminal may get it. C1 controls steer terminals as well; bidi
/// overrides reorder the line.
bool is_printable(uint32_t point) {
  return point >= 0x20 && (point < 0x7f || point >= 0xa0)
         && (point < 0x2028 || point > 0x202e)
         && (point < 0x2066 || point > 0x2069);
}

using point_range = std::pair<uint32_t, uint32_t>;

/// What stands above or within the character before it.
constexpr point_range combining[] = {
    {0x300, 0x36f},   {0x483, 0x489},   {0x591, 0x5bd},   {0x610, 0x61a},
    {0x64b, 0x65f},   {0x900, 0x902},   {0xe34, 0xe3a},   {0xe47, 0xe4e},
    {0x1ab0, 0x1aff}, {0x1dc0, 0x1dff}, {0x200b, 0x200f}, {0x20d0, 0x20f0},
    {0xfe00, 0xfe0f}, {0xfe20, 0xfe2f}, {0xfeff, 0xfeff}, {0xe0100, 0xe01ef}};

/// East Asian characters and emoji (Unicode, "wide" and "fullwidth").
constexpr point_range wide[] = {
    {0x1100, 0x115f},   {0x231a, 0x231b},   {0x23e9, 0x23ec},
    {0x25fd, 0x25fe},   {0x2614, 0x2615},   {0x2648, 0x2653},
    {0x26a1, 0x26a1},   {0x2705, 0x2705},   {0x274c, 0x274c},
    {0x2e80, 0x303e},   {0x3041, 0xa4cf},   {0xa960, 0xa97c},
    {0xac00, 0xd7a3},   {0xf900, 0xfaff},   {0xfe30, 0xfe6f},
    {0xff00, 0xff60},   {0xffe0, 0xffe6},   {0x1f004, 0x1f004},
    {0x1f0cf, 0x1f0cf}, {0x1f18e, 0x1f19a}, {0x1f200, 0x1f320},
    {0x1f32d, 0x1f64f}, {0x1f680, 0x1f6ff}, {0x1f7e0, 0x1f7eb},
    {0x1f90c, 0x1f9ff}, {0x1fa70, 0x1faff}, {0x20000, 0x3fffd}};

template <size_t N>
bool is_within(uint32_t point, const point_range (&ranges)[N]) {
  return std::any_of(std::begin(ranges), std::end(ranges), [&](const auto& x) {
    return point >= x.first && point <= x.second;
  });
}

/// Of what is no UTF-8 each byte is a column, as it is shown.
size_t columns_of(const decoded& x) {
  return x.length == 0                   ? 1
         : is_within(x.point, combining) ? 0
         : is_within(x.point, wide)      ? 2
                                         : 1;
}

/// Bytes of the beginning of `text` that find room in so many columns.
size_t bytes_within(std::string_view text, size_t width) {
  size_t end = 0;
  for (size_t used = 0; end < text.size();) {
    const auto next = decode_first(text.substr(end));
    used += columns_of(next);
    if (used > width)
      break;
    end += std::max<size_t>(1, next.length);
  }
  return end;
}

} // namespace

std::string printable(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const auto next = decode_first(text);
    const auto n = std::max<size_t>(1, next.length);
    if (next.length > 0 && is_printable(next.point))
      result += text.substr(0, n);
    else
      result += std::string(n, '?');
    text.remove_prefix(n);
  }
  return result;
}

size_t display_width(std::string_view text) {
  size_t width = 0;
  while (!text.empty()) {
    const auto next = decode_first(text);
    width += columns_of(next);
    text.remove_prefix(std::max<size_t>(1, next.length));
  }
  return width;
}

size_t letters_in(std::string_view text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char x) {
        return (static_cast<unsigned char>(x) & 0xc0) != 0x80;
      }));
}

std::string_view first_letter(std::string_view text) {
  auto size = std::max<size_t>(1, decode_first(text).length);
  while (size < text.size()) {
    const auto next = decode_first(text.substr(size));
    if (columns_of(next) > 0)
      break;
    size += next.length;
  }
  return text.substr(0, size);
}

std::string shortened(std::string_view text, size_t width) {
  if (bytes_within(text, width) == text.size())
    return std::string{text};
  if (width == 0)
    return {};
  return std::string{text.substr(0, bytes_within(text, width - 1))} + "…";
}

namespace {

/// Splits "2.5ms" into 2.5 and "ms".
std::pair<double, std::string_view> split_unit(std::string_view text) {
  const auto end = text.find_first_not_of("0123456789.");
  const auto digits = text.substr(0, end);
  double value = 0;
  auto [rest, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value,
                      std::chars_format::fixed);
  if (error != std::errc{} || rest != digits.data() + digits.size())
    throw std::invalid_argument{"not a number: '" + std::string{text} + "'"};
  return {value, end == text.npos ? std::string_view{} : text.substr(end)};
}

struct unit {
  std::string_view name;
  double factor;
};

template <size_t N>
double factor_of(std::string_view name, const std::array<unit, N>& units) {
  std::string known;
  for (const auto& u : units) {
    if (u.name == name)
      return u.factor;
    if (!u.name.empty())
      known += (known.empty() ? "" : ", ") + std::string{u.name};
  }
  throw std::invalid_argument{"unknown unit '" + std::string{name}
                              + "', known are " + known};
}

} // namespace

uint64_t parse_bytes(std::string_view text) {
  static constexpr std::array<unit, 5> units{{{"", 1},
                                              {"B", 1},
                                              {"KiB", 1024},
                                              {"MiB", 1048576},
                                              {"GiB", 1073741824}}};
  const auto [value, name] = split_unit(text);
  const auto bytes = value * factor_of(name, units);
  // From 2^53 on a double skips whole numbers.
  if (bytes != std::floor(bytes) || bytes > 9007199254740992.0)
    throw std::invalid_argument{"not a whole number of bytes: '"
                                + std::string{text} + "'"};
  return static_cast<uint64_t>(bytes);
}

std::chrono::milliseconds parse_duration(std::string_view text) {
  static constexpr std::array<unit, 5> units{
      {{"", 1000}, {"ms", 1}, {"s", 1000}, {"m", 60'000}, {"h", 3'600'000}}};
  const auto [value, name] = split_unit(text);
  const auto millis = value * factor_of(name, units);
  if (millis < 1 || millis > 86'400'000)
    throw std::invalid_argument{"not between 1 ms and 24 h: '"
                                + std::string{text} + "'"};
  return std::chrono::milliseconds{std::llround(millis)};
}

std::chrono::seconds parse_span(std::string_view text) {
  constexpr int64_t day = 24 * 3600;
  constexpr int64_t longest = 36'500 * day;
  static constexpr std::pair<char, int64_t> units[] = {
      {'s', 1}, {'m', 60}, {'h', 3600}, {'d', day}};
  const auto refuse = [&]() -> std::chrono::seconds {
    throw std::invalid_argument{"'" + std::string{text}
                                + "' is no span such as 90s, 5m, 2h or 7d"};
  };
  const auto* unit =
      text.empty()
          ? std::end(units)
          : std::find_if(std::begin(units), std::end(units),
                         [&](const auto& x) { return x.first == text.back(); });
  if (unit == std::end(units))
    return refuse();
  int64_t count = 0;
  const auto* end = text.data() + text.size() - 1;
  const auto [rest, error] = std::from_chars(text.data(), end, count);
  if (error != std::errc{} || rest != end || count < 0
      || count > longest / unit->second)
    return refuse();
  return std::chrono::seconds{count * unit->second};
}

} // namespace roscell::cli
