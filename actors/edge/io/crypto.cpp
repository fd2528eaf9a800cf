#include "actors/edge/io/crypto.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <stdexcept>

namespace roscell {

namespace {

constexpr std::string_view hex_digits = "0123456789abcdef";

/// The value of a hexadecimal digit; -1 if it is none.
int hex_value(char c) {
  if (c >= '0' && c <= '9')
    return c - '0';
  if (c >= 'a' && c <= 'f')
    return c - 'a' + 10;
  if (c >= 'A' && c <= 'F')
    return c - 'A' + 10;
  return -1;
}

const unsigned char* bytes_of(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

} // namespace

digest hmac_sha256(std::string_view key, std::string_view text) {
  // HMAC() takes a null key for "the key of the last call", so an empty view
  // must not pass its null pointer on.
  if (key.data() == nullptr)
    key = "";
  digest result{};
  unsigned size = 0;
  const auto* done =
      HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()),
           bytes_of(text), text.size(), result.data(), &size);
  if (done == nullptr || size != result.size())
    throw std::runtime_error("libcrypto cannot compute HMAC-SHA256");
  return result;
}

struct sha256_sum::context {
  EVP_MD_CTX* handle = EVP_MD_CTX_new();
};

sha256_sum::sha256_sum() : context_(std::make_unique<context>()) {
  if (context_->handle == nullptr
      || EVP_DigestInit_ex(context_->handle, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("libcrypto cannot compute SHA-256");
}

sha256_sum::~sha256_sum() {
  EVP_MD_CTX_free(context_->handle);
}

void sha256_sum::add(std::string_view bytes) {
  EVP_DigestUpdate(context_->handle, bytes.data(), bytes.size());
}

void sha256_sum::add_text(std::string_view text) {
  add(std::to_string(text.size()) + ':');
  add(text);
}

std::string sha256_sum::hex() {
  digest result{};
  EVP_DigestFinal_ex(context_->handle, result.data(), nullptr);
  return to_hex(result);
}

std::string sha256_hex(std::string_view bytes) {
  sha256_sum sum;
  sum.add(bytes);
  return sum.hex();
}

std::string_view as_bytes(const digest& value) {
  return {reinterpret_cast<const char*>(value.data()), value.size()};
}

std::string random_bytes(size_t size) {
  std::string result(size, '\0');
  auto* data = reinterpret_cast<unsigned char*>(result.data());
  if (RAND_bytes(data, static_cast<int>(size)) != 1)
    throw std::runtime_error("libcrypto has no random bytes");
  return result;
}

std::string to_hex(std::string_view bytes) {
  std::string result;
  result.reserve(bytes.size() * 2);
  for (const char c : bytes) {
    const auto byte = static_cast<uint8_t>(c);
    result += hex_digits[byte >> 4];
    result += hex_digits[byte & 0x0f];
  }
  return result;
}

std::string to_hex(const digest& value) {
  return to_hex(as_bytes(value));
}

std::optional<std::string> from_hex(std::string_view text) {
  if (text.size() % 2 != 0)
    return std::nullopt;
  std::string result;
  result.reserve(text.size() / 2);
  for (size_t i = 0; i < text.size(); i += 2) {
    const int high = hex_value(text[i]);
    const int low = hex_value(text[i + 1]);
    if (high < 0 || low < 0)
      return std::nullopt;
    result += static_cast<char>(high * 16 + low);
  }
  return result;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  return a.size() == b.size()
         && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

} // namespace roscell
