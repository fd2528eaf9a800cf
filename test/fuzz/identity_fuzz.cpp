#include "actors/edge/trust/chain_check.hpp"
#include "actors/edge/trust/identity_file.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

using namespace roscell;

namespace {

const site_trust& known_site() {
  static const auto key = private_key::make();
  static const site_trust site{make_site("hall", key, 1'780'000'000), nullptr};
  return site;
}

/// Nobody whom the site has not signed is believed, and what a certificate says
/// is a name, or nothing.
void look_at(const std::vector<certificate>& chain) {
  const auto found = check_chain(known_site(), chain, 1'780'000'000);
  if (std::holds_alternative<identity>(found))
    std::abort();
  for (const auto& x : chain)
    if (x.who() && !(identity_in(uri_of(*x.who())) == x.who()))
      std::abort();
}

} // namespace

/// Certificates, requests for them and files of identities, as DER and PEM.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  if (const auto one = certificate::from_der(bytes))
    look_at({*one});
  if (const auto some = certificates_in(bytes, 2))
    look_at(*some);
  (void)key_in_request(bytes);
  const auto own = read_identity(bytes);
  if (const auto* x = std::get_if<own_identity>(&own)) {
    const auto again = read_identity(text_of(*x));
    if (!std::holds_alternative<own_identity>(again))
      std::abort();
  }
  return 0;
}
