#include "actors/edge/trust/identity.hpp"
#include "actors/edge/trust/invitation.hpp"
#include "actors/edge/trust/revocations.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

using namespace roscell;

namespace {

struct known_site {
  private_key key = private_key::make();
  certificate mine = make_site("hall", key, 1'780'000'000);
};

/// The site has signed no list but its own, whatever bytes there are.
void read_revocations(std::string_view bytes) {
  static const known_site site;
  if (revocation_list::read(bytes, site.mine))
    std::abort();
}

} // namespace

/// Invitations, lists of the revoked and URIs of identities.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  std::string why;
  if (const auto x = read_invitation(bytes, why)) {
    if (!(read_invitation(line_of(*x), why) == x))
      std::abort();
  } else if (why.empty()) {
    std::abort();
  }
  if (const auto x = identity_in(bytes); x && uri_of(*x) != bytes)
    std::abort();
  if (const auto x = site_in(bytes); x && uri_of_site(*x) != bytes)
    std::abort();
  read_revocations(bytes);
  return 0;
}
