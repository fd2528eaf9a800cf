#pragma once

#include "actors/edge/trust/certificate.hpp"
#include "actors/edge/trust/revocations.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// Why somebody is not believed.
enum class distrust {
  no_certificate,
  too_long,    ///< More certificates than one and its issuer's.
  nobody,      ///< It is no certificate of a person or machine of a site.
  other_site,  ///< Or one that only has the same name.
  not_allowed, ///< The issuer may not sign for that role.
  revoked,
  ended,
  not_begun,
};

/// "other_site".
const char* to_word(distrust why);

struct distrusted {
  distrust why;
  std::string text; ///< A sentence without a full stop.
  std::string hint; ///< What to do about it; may be empty.
};

/// What a certificate is shown for.
enum class certificate_use {
  session,
  /// For its own renewal alone, also long after its end: what was switched off
  /// for a season comes back.
  renewal,
};

/// What one has to know of a site to believe others.
struct site_trust {
  certificate site;
  std::shared_ptr<const revocation_list> revoked; ///< Null: none is.
};

/// Who it is that shows this chain, his own certificate first. That he has the
/// key is to be proved elsewhere.
/// @param now_unix_s see `trusted_now`.
std::variant<identity, distrusted>
check_chain(const site_trust& trust, const std::vector<certificate>& chain,
            int64_t now_unix_s, certificate_use use = certificate_use::session);

/// The latest of what a clock says, what was known of time before, when one's
/// own certificate began and when this program was built: a clock that was set
/// back, or has never been set, is no reason to believe nobody.
int64_t trusted_now(int64_t clock_unix_s, int64_t known_unix_s,
                    int64_t own_begin_unix_s);

} // namespace roscell
