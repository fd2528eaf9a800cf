#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/trust/identity_file.hpp"
#include "actors/edge/trust/invitation.hpp"

#include <string>

namespace roscell {

/// Who comes to a site with an invitation.
struct site_newcomer {
  std::string name;
  std::string uuid;
};

/// What he gets there.
struct site_admission {
  own_identity own;
  std::string issuing; ///< The identity by which he makes others', or empty.
  std::string revoked; ///< The site's list.
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
edge_result<site_admission> enter_site(const invitation& by,
                                       const site_newcomer& who);

/// What an invitation keeps for him in place of a certificate: see `seal_text`.
/// @param issuing as in `site_admission`.
std::string deposit_of(const own_identity& own, const own_identity* issuing);

} // namespace roscell
