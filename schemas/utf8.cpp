#include "schemas/utf8.hpp"

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include <algorithm>
#include <cstddef>

namespace roscell {

namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";

/// What a first byte allows (Unicode standard, table 3-7).
struct sequence {
  size_t size = 0; ///< 0: it starts no character.
  unsigned second_from = 0x80;
  unsigned second_to = 0xBF;
};

sequence sequence_of(unsigned first) {
  if (first < 0x80)
    return {1};
  if (first < 0xC2 || first > 0xF4)
    return {0};
  if (first < 0xE0)
    return {2};
  if (first < 0xF0)
    return {3, first == 0xE0 ? 0xA0U : 0x80U, first == 0xED ? 0x9FU : 0xBFU};
  return {4, first == 0xF0 ? 0x90U : 0x80U, first == 0xF4 ? 0x8FU : 0xBFU};
}

/// How many bytes at the start of `text` fit to one character of which
/// `wanted` is what its first byte asks for.
size_t fitting(std::string_view text, const sequence& wanted) {
  const auto most = std::min(text.size(), wanted.size);
  size_t n = std::min<size_t>(most, 1);
  while (n < most) {
    const unsigned byte = static_cast<unsigned char>(text[n]);
    const bool fits =
        n == 1 ? byte >= wanted.second_from && byte <= wanted.second_to
               : byte >= 0x80 && byte <= 0xBF;
    if (!fits)
      break;
    ++n;
  }
  return n;
}

} // namespace

std::string valid_utf8(std::string_view bytes) {
  std::string result;
  result.reserve(bytes.size());
  while (!bytes.empty()) {
    const auto wanted = sequence_of(static_cast<unsigned char>(bytes[0]));
    const auto n = fitting(bytes, wanted);
    if (wanted.size > 0 && n == wanted.size)
      result += bytes.substr(0, n);
    else
      result += replacement;
    bytes.remove_prefix(std::max<size_t>(n, 1));
  }
  return result;
}

size_t valid_utf8_prefix(std::string_view bytes) {
  size_t n = 0;
  while (n < bytes.size()) {
    const auto rest = bytes.substr(n);
    const auto wanted = sequence_of(static_cast<unsigned char>(rest[0]));
    if (wanted.size == 0 || fitting(rest, wanted) != wanted.size)
      return n;
    n += wanted.size;
  }
  return n;
}

size_t unfinished_utf8(std::string_view bytes) {
  for (size_t n = 1; n <= std::min<size_t>(3, bytes.size()); ++n) {
    const auto tail = bytes.substr(bytes.size() - n);
    const auto wanted = sequence_of(static_cast<unsigned char>(tail[0]));
    if (wanted.size > n && fitting(tail, wanted) == n)
      return n;
  }
  return 0;
}

namespace {

namespace steps = boost::archive::iterators;

constexpr size_t group_bytes = 3;
constexpr size_t group_characters = 4;

} // namespace

std::string to_base64(std::string_view bytes) {
  using digits = steps::base64_from_binary<
      steps::transform_width<std::string::const_iterator, 6, 8>>;
  const auto missing = (group_bytes - bytes.size() % group_bytes) % group_bytes;
  std::string whole{bytes};
  whole.append(missing, '\0');
  std::string result{digits{whole.cbegin()}, digits{whole.cend()}};
  std::fill(result.end() - static_cast<std::ptrdiff_t>(missing), result.end(),
            '=');
  return result;
}

std::optional<std::string> from_base64(std::string_view text) {
  using bytes = steps::transform_width<
      steps::binary_from_base64<std::string::const_iterator>, 8, 6>;
  const auto end = text.find_last_not_of('=') + 1;
  const auto missing = text.size() - end;
  // Boost takes a '=' in the middle.
  if (text.size() % group_characters != 0 || missing >= group_bytes
      || text.substr(0, end).find('=') != std::string_view::npos)
    return std::nullopt;
  std::string whole{text};
  std::replace(whole.begin() + static_cast<std::ptrdiff_t>(end), whole.end(),
               '=', 'A');
  try {
    std::string result{bytes{whole.cbegin()}, bytes{whole.cend()}};
    result.resize(result.size() - missing);
    return result;
  } catch (const steps::dataflow_exception&) {
    return std::nullopt;
  }
}

} // namespace roscell
