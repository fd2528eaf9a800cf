#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace roscell {

namespace {

bool is_continuation(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

std::string counted(const char* what, size_t n, const char* part) {
  return std::string{what} + " of " + std::to_string(n) + " " + part
         + (n == 1 ? "" : "s");
}

std::string plain(double x) {
  constexpr double largest_exact_integer = 9007199254740992.0;
  if (std::abs(x) < largest_exact_integer && x == std::trunc(x))
    return std::to_string(static_cast<int64_t>(x));
  return json(x).dump();
}

} // namespace

size_t character_count(std::string_view utf8) {
  auto starts = std::count_if(utf8.begin(), utf8.end(),
                              [](char c) { return !is_continuation(c); });
  return static_cast<size_t>(starts);
}

std::string in_quotes(std::string_view text, size_t max_characters) {
  size_t end = 0;
  for (size_t n = 0; end < text.size(); ++end)
    if (!is_continuation(text[end]) && n++ == max_characters)
      break;
  auto head = json(std::string{text.substr(0, end)});
  auto result = head.dump(-1, ' ', false, json::error_handler_t::replace);
  if (end < text.size())
    result += "...";
  return result;
}

std::string absence_text(std::string_view name, const std::string& expected) {
  return "expected " + in_quotes(name) + ", " + expected
         + ", but it is missing";
}

std::string bounds_text(double minimum, double maximum) {
  const bool low = std::isfinite(minimum);
  const bool high = std::isfinite(maximum);
  if (low && high)
    return " from " + plain(minimum) + " to " + plain(maximum);
  if (low)
    return " of at least " + plain(minimum);
  return high ? " of at most " + plain(maximum) : "";
}

std::string shown_value(const json& value) {
  switch (value.type()) {
  case json::value_t::object:
    return counted("an object", value.size(), "member");
  case json::value_t::array:
    return counted("an array", value.size(), "item");
  case json::value_t::string: {
    const auto& text = value.get_ref<const std::string&>();
    auto n = character_count(text);
    auto words = in_quotes(text);
    return n > 40 ? words + " (" + std::to_string(n) + " characters)" : words;
  }
  case json::value_t::number_integer:
  case json::value_t::number_unsigned:
  case json::value_t::number_float:
    return "the number " + value.dump();
  default:
    return value.dump();
  }
}

} // namespace roscell
