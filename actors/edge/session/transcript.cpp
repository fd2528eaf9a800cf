#include "actors/edge/session/transcript.hpp"

namespace roscell {

transcript::transcript(std::string_view label) {
  add(label);
}

transcript& transcript::add(std::string_view text) {
  for (const int shift : {24, 16, 8, 0})
    bytes_ += static_cast<char>((text.size() >> shift) & 0xff);
  bytes_ += text;
  return *this;
}

transcript& transcript::add(int64_t number) {
  return add(std::string_view{std::to_string(number)});
}

digest transcript::sign(std::string_view key) const {
  return hmac_sha256(key, bytes_);
}

bool is_proof(std::string_view proof, const digest& expected) {
  const auto bytes = from_hex(proof);
  return bytes && equal_in_constant_time(*bytes, as_bytes(expected));
}

} // namespace roscell
