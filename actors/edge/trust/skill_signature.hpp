#pragma once

#include "actors/edge/trust/chain_check.hpp"
#include "actors/edge/trust/identity_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace roscell {

/// Says for a build that it is what its signer means it to be: his certificates
/// as PEM, and his signature over the build's hash.
/// @param hash see `build_name`.
std::string sign_build(const own_identity& by, const std::string& hash);

/// Who has signed that build: an operator of the site. The reader of outside
/// bytes; at most `limits::trust::identity_bytes`.
std::variant<identity, distrusted> check_signature(const site_trust& trust,
                                                   std::string_view signature,
                                                   const std::string& hash,
                                                   int64_t now_unix_s);

} // namespace roscell
