#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// What lets a node into a site: one line, which a person carries.
///
///     roscell1:SITE:DIGEST:HOST:PORT[,HOST:PORT...]:SECRET
///
/// DIGEST is the first half of the digest of the site's certificate, so that a
/// newcomer knows whom to believe before it says anything. SECRET is never
/// sent; that one has it is proved.
struct invitation {
  std::string site;
  std::string digest;                 ///< 32 hexadecimal digits.
  std::vector<std::string> addresses; ///< "HOST:PORT" of coordinators, 1 to 8.
  std::string secret;                 ///< 32 hexadecimal digits.

  friend bool operator==(const invitation& a, const invitation& b) {
    return a.site == b.site && a.digest == b.digest
           && a.addresses == b.addresses && a.secret == b.secret;
  }
};

constexpr size_t invitation_digits = 32;

std::string line_of(const invitation& x);

/// Spaces and line ends around it do not count. Else the place of what is
/// wrong, as a sentence in `why`.
std::optional<invitation> read_invitation(std::string_view line,
                                          std::string& why);

/// Whether that is the certificate, by its digest, which it speaks of.
bool speaks_of(const invitation& x, const std::string& certificate_digest);

/// What is made of the secret for whoever keeps the invitation: by it a proof
/// is checked, and nothing is opened that was sealed under the secret itself.
std::string proving_half(const std::string& secret);

/// By what a coordinator knows which of its invitations is meant; it tells
/// nothing of the half that proves.
std::string id_of_invitation(const std::string& proving);

/// A proof that one has it, good in one connection only.
/// @param proving see `proving_half`.
/// @param exported keying material of that connection (RFC 8446, 7.5).
std::string prove_invitation(const std::string& proving,
                             std::string_view exported);
bool proves_invitation(const std::string& proving, std::string_view exported,
                       std::string_view proof);

/// Names that keying material.
constexpr const char* invitation_label = "EXPORTER-roscell-invitation";

} // namespace roscell
