#pragma once

#include "actors/edge/trust/openssl_parts.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// A key of one who has an identity: ECDSA on P-256, the curve that browsers
/// take, too. Copies share it. From any thread.
class private_key {
public:
  static private_key make();

  /// None for what is no such key, or needs a passphrase. At most
  /// `limits::trust::key_bytes` are looked at.
  static std::optional<private_key> from_pem(std::string_view text);

  /// PKCS #8, not encrypted: for a file that its user alone can read.
  std::string pem() const;

  /// A request for a certificate of this key (PKCS #10, DER), which proves that
  /// whoever sends it has the key. It names nobody: who he is, the site says.
  std::string request() const;

  /// ECDSA with SHA-256 over these bytes, DER.
  std::string sign(std::string_view bytes) const;

  EVP_PKEY* get() const noexcept {
    return key_.get();
  }

private:
  explicit private_key(key_owner key);

  std::shared_ptr<EVP_PKEY> key_;
};

/// The key that has made a request, where the request proves that; none
/// otherwise, and for what is no request. The reader of outside bytes.
key_owner key_in_request(std::string_view der);

/// Whether the key is one that a site has to do with.
bool is_site_key(EVP_PKEY* key);

/// Whether `signature` is that of the key over these bytes.
bool is_signed_by(EVP_PKEY* key, std::string_view bytes,
                  std::string_view signature);

/// SHA-256 over the public half, in hexadecimal.
std::string digest_of_key(EVP_PKEY* key);

} // namespace roscell
