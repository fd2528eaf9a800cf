#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/trust/certificate_making.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace roscell {

/// What proves to others who one is, and by what others are believed: a key,
/// its certificate with that of an issuer behind it, and the site's own.
struct own_identity {
  private_key key;
  std::vector<certificate> chain; ///< One's own first.
  certificate site;

  const identity& who() const {
    return *chain.front().who();
  }
};

/// All of it in one file of PEM, as curl and others take it: key, chain, site.
std::string text_of(const own_identity& x);

/// Errors: schema_violation (it is none, a part is missing, or its key is
/// another one's).
edge_result<own_identity> read_identity(std::string_view text);

/// Errors: those, with the name of the file; unauthorized (others than its user
/// and root may change or read it).
edge_result<own_identity> read_identity_file(const std::filesystem::path& file);

} // namespace roscell
