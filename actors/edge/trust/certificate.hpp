#pragma once

#include "actors/edge/trust/identity.hpp"
#include "actors/edge/trust/openssl_parts.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// A certificate, with what we read of it. What it says is worth nothing until
/// `check_chain` has looked at it. Copies share it. From any thread.
class certificate {
public:
  /// None for what is no certificate, is longer than
  /// `limits::trust::certificate_bytes`, or has no key of a site. Readers of
  /// outside bytes.
  static std::optional<certificate> from_der(std::string_view bytes);
  static std::optional<certificate> of(certificate_owner x);

  std::string pem() const;

  /// Whose it is; none: it is no certificate of a person or a machine.
  const std::optional<identity>& who() const noexcept {
    return who_;
  }

  /// The site whose own it is; empty: it is none of a site.
  const std::string& site() const noexcept {
    return site_;
  }

  /// In hexadecimal.
  const std::string& serial() const noexcept {
    return serial_;
  }

  int64_t begins_unix_s() const noexcept {
    return begins_unix_s_;
  }

  int64_t ends_unix_s() const noexcept {
    return ends_unix_s_;
  }

  /// SHA-256 of the whole certificate, in hexadecimal.
  std::string digest() const;

  X509* get() const noexcept {
    return x509_.get();
  }

  /// Its public key.
  EVP_PKEY* key() const noexcept {
    return X509_get0_pubkey(x509_.get());
  }

private:
  explicit certificate(certificate_owner x);

  bool read();

  std::shared_ptr<X509> x509_;
  std::optional<identity> who_;
  std::string site_;
  std::string serial_;
  int64_t begins_unix_s_ = 0;
  int64_t ends_unix_s_ = 0;
};

/// All certificates in a text, in their order. None where one of them cannot be
/// read, or there are more than `most`.
std::optional<std::vector<certificate>> certificates_in(std::string_view pem,
                                                        size_t most);

} // namespace roscell
