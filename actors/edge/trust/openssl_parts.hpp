#pragma once

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <string_view>

/// Owners of what OpenSSL hands out, and its texts.
namespace roscell {

template <auto Release>
struct released_by {
  template <class T>
  void operator()(T* x) const noexcept {
    Release(x);
  }
};

using bio_owner = std::unique_ptr<BIO, released_by<BIO_free_all>>;
using key_owner = std::unique_ptr<EVP_PKEY, released_by<EVP_PKEY_free>>;
using certificate_owner = std::unique_ptr<X509, released_by<X509_free>>;
using number_owner = std::unique_ptr<BIGNUM, released_by<BN_free>>;
using request_owner = std::unique_ptr<X509_REQ, released_by<X509_REQ_free>>;

/// Reads from these bytes, which must outlive it.
bio_owner reading(std::string_view bytes);

/// Somewhere to write to, and what was written.
bio_owner writing();
std::string written_to(const bio_owner& bio);

/// Throws std::runtime_error: OpenSSL has failed at what cannot fail but for
/// want of memory. Forgets what it had to say.
[[noreturn]] void openssl_failed(const char* what);

/// The same unless it was done.
void expect_done(bool done, const char* what);

/// Forgets what OpenSSL has to say of bytes that it could not read.
void forget_openssl_errors();

} // namespace roscell
