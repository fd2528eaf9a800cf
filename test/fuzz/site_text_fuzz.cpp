#include "actors/edge/trust/identity.hpp"
#include "actors/edge/trust/invitation.hpp"
#include "actors/edge/trust/revocations.hpp"
#include "actors/edge/trust/sealed_text.hpp"
#include "actors/edge/trust/skill_signature.hpp"

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

/// The site has signed nothing, and sealed nothing, whatever bytes there are.
void read_what_is_proved(std::string_view bytes) {
  static const known_site site;
  if (revocation_list::read(bytes, site.mine) || open_sealed("a secret", bytes)
      || std::holds_alternative<identity>(check_signature(
          {site.mine, nullptr}, bytes, "a hash", 1'780'000'000)))
    std::abort();
  // A request proves itself, so there are some.
  (void)key_in_request(bytes);
}

} // namespace

/// Invitations, lists of the revoked, URIs of identities, signatures of builds,
/// sealed texts and requests for certificates.
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
  read_what_is_proved(bytes);
  return 0;
}
