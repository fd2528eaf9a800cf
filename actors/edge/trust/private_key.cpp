#include "actors/edge/trust/private_key.hpp"

#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/limits.hpp"

#include <openssl/ec.h>
#include <openssl/pem.h>

#include <utility>

namespace roscell {

namespace {

using digest_owner = std::unique_ptr<EVP_MD_CTX, released_by<EVP_MD_CTX_free>>;

const unsigned char* bytes_of(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}

/// Nobody is asked for a passphrase.
int no_passphrase(char*, int, int, void*) {
  return -1;
}

template <class T>
std::string der_of(T* x, int (*encode)(const T*, unsigned char**)) {
  unsigned char* bytes = nullptr;
  const auto size = encode(x, &bytes);
  if (size < 0)
    openssl_failed("encoding");
  std::string result{reinterpret_cast<char*>(bytes), static_cast<size_t>(size)};
  OPENSSL_free(bytes);
  return result;
}

} // namespace

private_key::private_key(key_owner key) : key_(std::move(key)) {
  // nop
}

private_key private_key::make() {
  key_owner key{EVP_EC_gen("P-256")};
  if (!key)
    openssl_failed("EVP_EC_gen");
  return private_key{std::move(key)};
}

std::optional<private_key> private_key::from_pem(std::string_view text) {
  // OpenSSL takes a millisecond to find out that there is none.
  if (text.find("PRIVATE KEY-----") == std::string_view::npos)
    return std::nullopt;
  const auto in = reading(text.substr(0, limits::trust::key_bytes));
  key_owner key{
      PEM_read_bio_PrivateKey(in.get(), nullptr, no_passphrase, nullptr)};
  forget_openssl_errors();
  if (!key || !is_site_key(key.get()))
    return std::nullopt;
  return private_key{std::move(key)};
}

std::string private_key::pem() const {
  const auto out = writing();
  if (PEM_write_bio_PrivateKey(out.get(), key_.get(), nullptr, nullptr, 0,
                               nullptr, nullptr)
      != 1)
    openssl_failed("PEM_write_bio_PrivateKey");
  return written_to(out);
}

std::string private_key::request() const {
  const request_owner request{X509_REQ_new()};
  if (!request || X509_REQ_set_version(request.get(), X509_REQ_VERSION_1) != 1
      || X509_REQ_set_pubkey(request.get(), key_.get()) != 1
      || X509_REQ_sign(request.get(), key_.get(), EVP_sha256()) == 0)
    openssl_failed("X509_REQ_sign");
  return der_of(request.get(), i2d_X509_REQ);
}

std::string private_key::sign(std::string_view bytes) const {
  const digest_owner context{EVP_MD_CTX_new()};
  size_t size = 0;
  if (!context
      || EVP_DigestSignInit(context.get(), nullptr, EVP_sha256(), nullptr,
                            key_.get())
             != 1
      || EVP_DigestSign(context.get(), nullptr, &size, bytes_of(bytes),
                        bytes.size())
             != 1)
    openssl_failed("EVP_DigestSign");
  std::string result(size, '\0');
  if (EVP_DigestSign(context.get(),
                     reinterpret_cast<unsigned char*>(result.data()), &size,
                     bytes_of(bytes), bytes.size())
      != 1)
    openssl_failed("EVP_DigestSign");
  result.resize(size);
  return result;
}

key_owner key_in_request(std::string_view der) {
  if (der.size() > limits::trust::certificate_bytes)
    return nullptr;
  const auto* at = bytes_of(der);
  const auto* end = at + der.size();
  const request_owner request{
      d2i_X509_REQ(nullptr, &at, static_cast<long>(der.size()))};
  key_owner key{request && at == end ? X509_REQ_get_pubkey(request.get())
                                     : nullptr};
  const bool is_proved = key && is_site_key(key.get())
                         && X509_REQ_verify(request.get(), key.get()) == 1;
  forget_openssl_errors();
  return is_proved ? std::move(key) : nullptr;
}

bool is_site_key(EVP_PKEY* key) {
  std::array<char, 32> group{};
  size_t size = 0;
  const bool is_known =
      EVP_PKEY_get_base_id(key) == EVP_PKEY_EC
      && EVP_PKEY_get_group_name(key, group.data(), group.size(), &size) == 1;
  forget_openssl_errors();
  return is_known && std::string_view{group.data(), size} == "prime256v1";
}

bool is_signed_by(EVP_PKEY* key, std::string_view bytes,
                  std::string_view signature) {
  const digest_owner context{EVP_MD_CTX_new()};
  const bool result =
      context
      && EVP_DigestVerifyInit(context.get(), nullptr, EVP_sha256(), nullptr,
                              key)
             == 1
      && EVP_DigestVerify(context.get(), bytes_of(signature), signature.size(),
                          bytes_of(bytes), bytes.size())
             == 1;
  forget_openssl_errors();
  return result;
}

std::string digest_of_key(EVP_PKEY* key) {
  return sha256_hex(der_of(key, i2d_PUBKEY));
}

} // namespace roscell
