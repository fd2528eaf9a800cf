#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/invitation.hpp"

#include <string>

namespace roscell {

/// Who comes to a site with an invitation.
struct site_newcomer {
  std::string name;
  std::string uuid;
};

/// Proves an invitation to the coordinators that it names, one after another,
/// and comes back with an identity: of a key that is made here, or one that was
/// made for him. The secret is not sent, and nobody is believed whose site is
/// not the one that the invitation speaks of. Waits for the network, some
/// seconds for each address.
///
/// Errors: unreachable (none of them answers), unauthorized (the invitation is
/// unknown, used or over, or is for another name; another site is there),
/// schema_violation (what came makes no sense), internal.
edge_result<kept_identity> enter_site(const invitation& by,
                                      const site_newcomer& who);

/// What an invitation keeps for him in place of a certificate: see `seal_text`.
std::string deposit_of(const kept_identity& x);

} // namespace roscell
