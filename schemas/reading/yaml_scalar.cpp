#include "schemas/reading/yaml_scalar.hpp"

#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>

namespace roscell {

namespace {

constexpr std::string_view digits = "0123456789";

template <class... Words>
bool is_one_of(std::string_view text, Words... words) {
  return ((text == words) || ...);
}

bool consists_of(std::string_view text, std::string_view characters) {
  return !text.empty()
         && text.find_first_not_of(characters) == std::string_view::npos;
}

/// The number that is all of `text`; none if there is no such, or if it does
/// not fit.
template <class Number, class... Form>
std::optional<json> number(std::string_view text, Form... form) {
  Number result{};
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result, form...);
  if (error != std::errc{} || rest != end)
    return std::nullopt;
  return json(result);
}

/// Digits after an optional sign; as in JSON, what 64 bits cannot hold becomes
/// a floating-point number.
std::optional<json> decimal(std::string_view text) {
  if (auto result =
          text.front() == '-' ? number<int64_t>(text) : number<uint64_t>(text))
    return result;
  return number<double>(text);
}

/// True for what begins like a number and goes on as one to its end.
bool is_floating(std::string_view magnitude) {
  double ignored = 0;
  const auto* end = magnitude.data() + magnitude.size();
  return !magnitude.empty()
         && (digits.find(magnitude.front()) != std::string_view::npos
             || magnitude.front() == '.')
         && std::from_chars(magnitude.data(), end, ignored).ptr == end;
}

} // namespace

std::optional<json> plain_scalar(const std::string& text) {
  if (is_one_of(text, "", "~", "null", "Null", "NULL"))
    return json(nullptr);
  if (is_one_of(text, "true", "True", "TRUE"))
    return json(true);
  if (is_one_of(text, "false", "False", "FALSE"))
    return json(false);
  std::string_view signed_number = text;
  if (text.front() == '+')
    signed_number.remove_prefix(1);
  auto magnitude = signed_number;
  if (text.front() == '-')
    magnitude.remove_prefix(1);
  if (is_one_of(magnitude, ".inf", ".Inf", ".INF")
      || is_one_of(text, ".nan", ".NaN", ".NAN"))
    return std::nullopt;
  if (consists_of(magnitude, digits))
    return decimal(signed_number);
  const auto prefix = text.substr(0, 2);
  const auto rest = std::string_view{text}.substr(prefix.size());
  if (prefix == "0x" && consists_of(rest, "0123456789abcdefABCDEF"))
    return number<uint64_t>(rest, 16);
  if (prefix == "0o" && consists_of(rest, "01234567"))
    return number<uint64_t>(rest, 8);
  if (is_floating(magnitude))
    return number<double>(signed_number);
  return json(text);
}

} // namespace roscell
