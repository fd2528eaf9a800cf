#pragma once

#include "actors/edge/trust/certificate.hpp"
#include "actors/edge/trust/private_key.hpp"

#include <cstdint>
#include <string>

/// How certificates are made. All begin a day early, for clocks that are
/// behind, and have a random serial of 128 bits.
namespace roscell {

/// A key and the certificate that speaks of it.
struct signer {
  private_key key;
  certificate mine;
};

/// What a site trusts: a certificate that has signed itself.
certificate make_site(const std::string& site, const private_key& key,
                      int64_t now_unix_s);

/// One for whoever has that key. It never ends after its signer's. Not looked
/// at is whether the signer may: see `check_chain`.
/// @param good_for_s see `good_for_of`.
certificate make_certificate(const identity& who, EVP_PKEY* key,
                             const signer& by, int64_t now_unix_s,
                             int64_t good_for_s);

/// For how long certificates of a role are made, in seconds.
int64_t good_for_of(site_role role);

} // namespace roscell
