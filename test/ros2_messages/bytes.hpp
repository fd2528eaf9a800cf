#pragma once

#include <string>
#include <string_view>

namespace roscell::test {

/// The bytes that hexadecimal digits stand for; blanks do not count.
inline std::string bytes_of(std::string_view hex) {
  std::string result;
  std::string digits;
  for (char c : hex) {
    if (c != ' ')
      digits.push_back(c);
    if (digits.size() == 2) {
      result.push_back(static_cast<char>(std::stoi(digits, nullptr, 16)));
      digits.clear();
    }
  }
  return result;
}

/// The digits of bytes, for a readable failure.
inline std::string hex_of(std::string_view bytes) {
  constexpr auto digits = "0123456789abcdef";
  std::string result;
  for (char c : bytes) {
    auto byte = static_cast<unsigned char>(c);
    result.push_back(digits[byte >> 4]);
    result.push_back(digits[byte & 15]);
  }
  return result;
}

} // namespace roscell::test
