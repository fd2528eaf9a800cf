#include "actors/edge/http/http_target.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"

#include <algorithm>

namespace roscell {

namespace {

std::optional<std::string> decode(std::string_view text, bool plus_is_space) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      const auto byte = from_hex(text.substr(i + 1, 2));
      if (!byte || byte->size() != 1)
        return std::nullopt;
      result += *byte;
      i += 2;
    } else {
      result += plus_is_space && text[i] == '+' ? ' ' : text[i];
    }
  }
  if (std::any_of(result.begin(), result.end(), is_control))
    return std::nullopt;
  return result;
}

void append_escaped(std::string& to, char c) {
  constexpr std::string_view digits = "0123456789ABCDEF";
  const auto byte = static_cast<unsigned char>(c);
  to += '%';
  to += digits[byte >> 4];
  to += digits[byte & 0xf];
}

bool parse_pair(std::string_view pair,
                std::map<std::string, std::string>& query) {
  if (pair.empty())
    return true;
  const auto equals = pair.find('=');
  const auto key = decode(pair.substr(0, equals), true);
  const auto value = equals == std::string_view::npos
                         ? std::optional{std::string{}}
                         : decode(pair.substr(equals + 1), true);
  if (!key || !value)
    return false;
  query[*key] = *value;
  return true;
}

} // namespace

std::optional<http_target> parse_target(std::string_view target) {
  const auto mark = target.find('?');
  const auto path = decode(target.substr(0, mark), false);
  if (!path || path->empty() || path->front() != '/')
    return std::nullopt;
  http_target result{*path, {}};
  auto rest = mark == std::string_view::npos ? std::string_view{}
                                             : target.substr(mark + 1);
  while (!rest.empty()) {
    const auto end = std::min(rest.find('&'), rest.size());
    if (!parse_pair(rest.substr(0, end), result.query))
      return std::nullopt;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return result;
}

std::string percent_encode(std::string_view text) {
  constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyz"
                                     "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                     "0123456789-._~";
  std::string result;
  for (const char c : text)
    if (plain.find(c) != std::string_view::npos)
      result += c;
    else
      append_escaped(result, c);
  return result;
}

std::string encode_path(const std::string& path) {
  std::string result;
  size_t begin = 0;
  for (size_t i = 0; i <= path.size(); ++i)
    if (i == path.size() || path[i] == '/') {
      result += percent_encode(std::string_view{path}.substr(begin, i - begin));
      result += i < path.size() ? "/" : "";
      begin = i + 1;
    }
  return result.substr(0, 2) == "//" ? "/" : result;
}

} // namespace roscell
