#include "actors/edge/io/plain_text.hpp"

#include "actors/edge/io/limits.hpp"

#include <algorithm>

namespace roscell {

namespace {

/// As ASCII has them, whatever the locale.
bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
         || (c >= '0' && c <= '9');
}

bool is_name_part(char c) {
  return is_letter_or_digit(c) || c == '_' || c == '.' || c == '-';
}

} // namespace

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= limits::text::name_bytes
         && is_letter_or_digit(text.front())
         && std::all_of(text.begin(), text.end(), is_name_part);
}

bool is_uuid(std::string_view text) {
  return !text.empty() && text.size() <= limits::text::uuid_bytes
         && text.find_first_not_of("0123456789abcdefABCDEF-")
                == std::string_view::npos;
}

} // namespace roscell
