#pragma once

#include "actors/edge/trust/certificate_making.hpp"
#include "actors/edge/trust/chain_check.hpp"
#include "actors/edge/trust/limits.hpp"

#include <memory>
#include <string>
#include <vector>

namespace roscell::test {

constexpr int64_t site_made_unix_s = 1'780'000'000;

/// A site with one issuer, made at `site_made_unix_s`.
struct made_site {
  explicit made_site(const std::string& called = "hall")
      : name(called), key(private_key::make()),
        mine(make_site(called, key, site_made_unix_s)),
        issuer(issue(site_role::issuer, "edge")), trust{mine, nullptr} {
    // nop
  }

  identity called(site_role role, const std::string& who) const {
    return {name, role, who, "0a1b2c3d-0000-4000-8000-000000000001"};
  }

  signer issue(site_role role, const std::string& who,
               int64_t at = site_made_unix_s) const {
    auto made = private_key::make();
    auto x = make_certificate(called(role, who), made.get(), {key, mine}, at,
                              good_for_of(role));
    return {made, x};
  }

  /// Signed by the issuer.
  std::vector<certificate> issued_by_issuer(const identity& who) const {
    const auto made = private_key::make();
    return {make_certificate(who, made.get(), issuer, site_made_unix_s,
                             good_for_of(who.role)),
            issuer.mine};
  }

  /// Why that chain is not believed; empty: it is.
  std::string
  distrust_of(const std::vector<certificate>& chain,
              int64_t now = site_made_unix_s,
              certificate_use use = certificate_use::session) const {
    const auto found = check_chain(trust, chain, now, use);
    const auto* why = std::get_if<distrusted>(&found);
    return why == nullptr ? "" : to_word(why->why);
  }

  std::string name;
  private_key key;
  certificate mine;
  signer issuer;
  site_trust trust;
};

} // namespace roscell::test
