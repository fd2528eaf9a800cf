#include "actors/edge/trust/identity.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace roscell {

namespace {

constexpr std::string_view scheme = "spiffe://";
constexpr size_t max_site_bytes = 63;

constexpr std::array<std::pair<site_role, const char*>, 5> role_words{{
    {site_role::node, "node"},
    {site_role::coordinator, "coordinator"},
    {site_role::operating, "operator"},
    {site_role::viewer, "viewer"},
    {site_role::issuer, "issuer"},
}};

bool is_small(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

/// What follows the scheme; empty: it is another one.
std::string_view without_scheme(std::string_view uri) {
  return uri.substr(0, scheme.size()) == scheme ? uri.substr(scheme.size())
                                                : std::string_view{};
}

} // namespace

const char* to_word(site_role role) {
  for (const auto& [known, word] : role_words)
    if (known == role)
      return word;
  return "";
}

std::optional<site_role> role_from(std::string_view word) {
  for (const auto& [role, known] : role_words)
    if (known == word)
      return role;
  return std::nullopt;
}

bool is_site_name(std::string_view text) {
  return !text.empty() && text.size() <= max_site_bytes
         && is_small(text.front()) && is_small(text.back())
         && std::all_of(text.begin(), text.end(),
                        [](char c) { return is_small(c) || c == '-'; });
}

std::string make_uuid() {
  auto bytes = random_bytes(16);
  bytes[6] = static_cast<char>((bytes[6] & 0x0f) | 0x40);
  bytes[8] = static_cast<char>((bytes[8] & 0x3f) | 0x80);
  auto hex = to_hex(bytes);
  for (const size_t dash : {8, 13, 18, 23})
    hex.insert(dash, "-");
  return hex;
}

std::string uri_of(const identity& x) {
  return uri_of_site(x.site) + "/" + to_word(x.role) + "/" + x.name + "/"
         + x.uuid;
}

std::optional<identity> identity_in(std::string_view uri) {
  auto rest = without_scheme(uri);
  identity result;
  result.site = take_until(rest, '/');
  const auto role = role_from(take_until(rest, '/'));
  result.name = take_until(rest, '/');
  result.uuid = rest;
  if (!is_site_name(result.site) || !role || !is_name(result.name)
      || !is_uuid(result.uuid))
    return std::nullopt;
  result.role = *role;
  return result;
}

std::string uri_of_site(std::string_view site) {
  return std::string{scheme} + std::string{site};
}

std::optional<std::string> site_in(std::string_view uri) {
  const auto site = without_scheme(uri);
  return is_site_name(site) ? std::optional{std::string{site}} : std::nullopt;
}

std::string dns_name_of(const identity& x) {
  auto result = x.name;
  for (auto& c : result) {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!is_small(c))
      c = '-';
  }
  return result + "." + x.site + ".roscell.internal";
}

std::string text_of(const identity& x) {
  return std::string{to_word(x.role)} + " '" + x.name + "' of site '" + x.site
         + "'";
}

} // namespace roscell
