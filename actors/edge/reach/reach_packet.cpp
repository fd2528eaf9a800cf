#include "actors/edge/reach/reach_packet.hpp"

#include <algorithm>
#include <string>

namespace roscell {

namespace {

constexpr std::string_view magic = "ROSCELL";
constexpr std::size_t signed_size = 24;
constexpr char question_mark = '?';
constexpr char answer_mark = '!';

reach_bytes encode(char mark, std::string_view nonce, const digest& key) {
  reach_bytes result{};
  auto* end = std::copy(magic.begin(), magic.end(), result.data());
  *end++ = mark;
  end = std::copy(nonce.begin(), nonce.end(), end);
  const auto mac = hmac_sha256(as_bytes(key), {result.data(), signed_size});
  std::copy_n(as_bytes(mac).begin(), reach_packet_size - signed_size, end);
  return result;
}

std::string_view view(const reach_bytes& x) {
  return {x.data(), x.size()};
}

std::string_view view(const reach_nonce& x) {
  return {x.data(), x.size()};
}

/// The nonce of a datagram with that mark; empty if it is none, or forged.
std::string_view authentic_nonce(std::string_view datagram, char mark,
                                 const digest& key) {
  if (datagram.size() < reach_packet_size
      || datagram.substr(0, magic.size()) != magic
      || datagram[magic.size()] != mark)
    return {};
  const auto nonce =
      datagram.substr(magic.size() + 1, signed_size - magic.size() - 1);
  const auto genuine = encode(mark, nonce, key);
  return equal_in_constant_time(datagram.substr(0, reach_packet_size),
                                view(genuine))
             ? nonce
             : std::string_view{};
}

} // namespace

digest reach_key(std::string_view site_token) {
  return hmac_sha256(site_token, "roscell reach 1");
}

reach_nonce make_reach_nonce() {
  reach_nonce result{};
  const auto bytes = random_bytes(result.size());
  std::copy(bytes.begin(), bytes.end(), result.begin());
  return result;
}

std::vector<std::uint8_t> reach_question(const reach_nonce& nonce,
                                         const digest& key, std::size_t size) {
  const auto bytes = encode(question_mark, view(nonce), key);
  std::vector<std::uint8_t> result(bytes.begin(), bytes.end());
  result.resize(std::max(size, reach_packet_size));
  return result;
}

std::optional<reach_bytes> reach_answer(std::string_view datagram,
                                        std::string_view site_token) {
  if (site_token.empty() || datagram.substr(0, magic.size()) != magic)
    return std::nullopt;
  const auto key = reach_key(site_token);
  const auto nonce = authentic_nonce(datagram, question_mark, key);
  if (nonce.empty())
    return std::nullopt;
  return encode(answer_mark, nonce, key);
}

bool is_reach_answer(std::string_view datagram, const reach_nonce& nonce,
                     const digest& key) {
  return authentic_nonce(datagram, answer_mark, key) == view(nonce);
}

} // namespace roscell
