#include "actors/edge/trust/sealed_text.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/openssl_parts.hpp"

#include <openssl/evp.h>

#include <memory>

namespace roscell {

namespace {

constexpr size_t nonce_bytes = 12;
constexpr size_t tag_bytes = 16;

using cipher_owner =
    std::unique_ptr<EVP_CIPHER_CTX, released_by<EVP_CIPHER_CTX_free>>;

const unsigned char* to_bytes(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

unsigned char* to_bytes(std::string& text) {
  return reinterpret_cast<unsigned char*>(text.data());
}

int size_of_text(std::string_view text) {
  return static_cast<int>(text.size());
}

cipher_owner begin_cipher(std::string_view secret, std::string_view nonce,
                          bool sealing) {
  const auto key = hmac_sha256(secret, "roscell sealed text");
  cipher_owner result{EVP_CIPHER_CTX_new()};
  expect_done(result
                  && EVP_CipherInit_ex(result.get(), EVP_aes_256_gcm(), nullptr,
                                       key.data(), to_bytes(nonce),
                                       sealing ? 1 : 0)
                         == 1,
              "AES-256-GCM");
  return result;
}

} // namespace

std::string seal_text(std::string_view secret, std::string_view text) {
  const auto nonce = random_bytes(nonce_bytes);
  const auto cipher = begin_cipher(secret, nonce, true);
  std::string body(text.size(), '\0');
  std::string tag(tag_bytes, '\0');
  int size = 0;
  expect_done(EVP_CipherUpdate(cipher.get(), to_bytes(body), &size,
                               to_bytes(text), size_of_text(text))
                      == 1
                  && EVP_CipherFinal_ex(cipher.get(), nullptr, &size) == 1
                  && EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_GET_TAG,
                                         static_cast<int>(tag_bytes),
                                         tag.data())
                         == 1,
              "AES-256-GCM");
  return nonce + tag + body;
}

std::optional<std::string> open_sealed(std::string_view secret,
                                       std::string_view sealed) {
  if (sealed.size() < nonce_bytes + tag_bytes)
    return std::nullopt;
  const auto cipher =
      begin_cipher(secret, sealed.substr(0, nonce_bytes), false);
  std::string tag{sealed.substr(nonce_bytes, tag_bytes)};
  const auto body = sealed.substr(nonce_bytes + tag_bytes);
  std::string result(body.size(), '\0');
  int size = 0;
  const bool whole =
      EVP_CipherUpdate(cipher.get(), to_bytes(result), &size, to_bytes(body),
                       size_of_text(body))
          == 1
      && EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_SET_TAG,
                             static_cast<int>(tag_bytes), tag.data())
             == 1
      && EVP_CipherFinal_ex(cipher.get(), nullptr, &size) == 1;
  forget_openssl_errors();
  return whole ? std::optional{std::move(result)} : std::nullopt;
}

} // namespace roscell
