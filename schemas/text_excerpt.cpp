#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

namespace {

/// Longer texts are not compared: the time grows with the product of lengths.
constexpr size_t max_compared = 64;

/// Levenshtein's distance, row by row.
size_t distance(std::string_view x, std::string_view y) {
  std::vector<size_t> row(y.size() + 1);
  for (size_t j = 0; j <= y.size(); ++j)
    row[j] = j;
  for (size_t i = 1; i <= x.size(); ++i) {
    auto diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= y.size(); ++j) {
      auto replaced = diagonal + (x[i - 1] == y[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

} // namespace

std::string_view closest_word(std::string_view typed,
                              const std::vector<std::string_view>& words) {
  std::string_view result;
  if (typed.size() > max_compared)
    return result;
  auto best = max_compared;
  for (auto word : words) {
    auto d = distance(typed, word);
    if (d < best && d * 3 <= word.size()) {
      best = d;
      result = word;
    }
  }
  return result;
}

std::string unknown_name_text(const std::string& kind, std::string_view name,
                              const std::vector<std::string_view>& known) {
  auto result = "there is no " + kind + " " + in_quotes(name);
  if (const auto meant = closest_word(name, known); !meant.empty())
    return result + "; did you mean " + in_quotes(meant) + "?";
  result += known.empty() ? "" : "; there are";
  for (const auto& each : known)
    result += (&each == &known.front() ? " " : ", ") + std::string{each};
  return result;
}

} // namespace roscell
