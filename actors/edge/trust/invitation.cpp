#include "actors/edge/trust/invitation.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/trust/identity.hpp"
#include "actors/edge/trust/limits.hpp"

#include <algorithm>
#include <charconv>

namespace roscell {

namespace {

constexpr std::string_view version = "roscell1";
constexpr size_t max_addresses = 8;

bool is_hex(std::string_view text, size_t digits) {
  return text.size() == digits
         && text.find_first_not_of("0123456789abcdef")
                == std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view spaces = " \t\r\n";
  const auto begin = text.find_first_not_of(spaces);
  if (begin == std::string_view::npos)
    return {};
  return text.substr(begin, text.find_last_not_of(spaces) - begin + 1);
}

bool is_host(std::string_view text) {
  constexpr size_t longest = 253; // As DNS has it.
  return !text.empty() && text.size() <= longest
         && std::all_of(text.begin(), text.end(), [](char c) {
              return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')
                     || (c >= '0' && c <= '9') || c == '.' || c == '-';
            });
}

bool is_port(std::string_view text) {
  uint16_t result = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  return error == std::errc{} && rest == end && result > 0;
}

/// Takes "HOST:PORT" and the mark behind it off the front.
/// @param last whether none follows.
std::optional<std::string> take_address(std::string_view& text, bool& last) {
  const auto host = take_until(text, ':');
  const auto end = std::min(text.find_first_of(",:"), text.size());
  const auto port = text.substr(0, end);
  last = end == text.size() || text[end] == ':';
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!is_host(host) || !is_port(port))
    return std::nullopt;
  return std::string{host} + ":" + std::string{port};
}

} // namespace

std::string line_of(const invitation& x) {
  std::string result{version};
  result += ":" + x.site + ":" + x.digest + ":";
  for (const auto& address : x.addresses)
    result += (&address == &x.addresses.front() ? "" : ",") + address;
  return result + ":" + x.secret;
}

std::optional<invitation> read_invitation(std::string_view line,
                                          std::string& why) {
  auto rest = trimmed(line);
  const auto refuse = [&why](const char* text) {
    why = text;
    return std::nullopt;
  };
  if (rest.empty() || rest.size() > limits::trust::invitation_bytes)
    return refuse("an invitation is one line of up to 512 characters");
  if (take_until(rest, ':') != version)
    return refuse("an invitation begins with 'roscell1:'");
  invitation result;
  result.site = take_until(rest, ':');
  if (!is_site_name(result.site))
    return refuse("its second part is no name of a site");
  result.digest = take_until(rest, ':');
  if (!is_hex(result.digest, invitation_digits))
    return refuse("its third part is no digest of 32 hexadecimal digits");
  for (bool last = false; !last;) {
    auto address = take_address(rest, last);
    if (!address || result.addresses.size() == max_addresses)
      return refuse("its fourth part is not one to eight HOST:PORT");
    result.addresses.push_back(std::move(*address));
  }
  result.secret = rest;
  if (!is_hex(result.secret, invitation_digits))
    return refuse("its last part is no secret of 32 hexadecimal digits: is it "
                  "whole?");
  return result;
}

bool speaks_of(const invitation& x, const std::string& certificate_digest) {
  return x.digest.size() == invitation_digits
         && certificate_digest.compare(0, x.digest.size(), x.digest) == 0;
}

std::string proving_half(const std::string& secret) {
  return to_hex(hmac_sha256(secret, "roscell invitation proof"))
      .substr(0, invitation_digits);
}

std::string id_of_invitation(const std::string& proving) {
  return sha256_hex("roscell invitation " + proving)
      .substr(0, invitation_digits);
}

std::string prove_invitation(const std::string& proving,
                             std::string_view exported) {
  return to_hex(hmac_sha256(proving, exported));
}

bool proves_invitation(const std::string& proving, std::string_view exported,
                       std::string_view proof) {
  return !proving.empty()
         && equal_in_constant_time(prove_invitation(proving, exported), proof);
}

} // namespace roscell
