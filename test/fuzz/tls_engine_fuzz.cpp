#include "actors/edge/trust/tls_engine.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

using namespace roscell;

namespace {

/// One of a site who takes connections, and one who makes them.
struct known_site {
  private_key key = private_key::make();
  certificate mine = make_site("hall", key, 1'780'000'000);
  own_identity own = make_own();
  tls_settings settings{own, [this] {
                          return trust_now{{mine, nullptr}, 1'780'000'000};
                        }};

  own_identity make_own() const {
    const identity who{"hall", site_role::coordinator, "head",
                       "0a1b2c3d-0000-4000-8000-000000000001"};
    const auto own_key = private_key::make();
    return {own_key,
            {make_certificate(who, own_key.get(), {key, mine}, 1'780'000'000,
                              1'000'000)},
            mine};
  }
};

/// Whatever comes, nobody is let in who has not proved who he is.
void let_in(tls_engine& x, std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size(); i += 100) {
    x.take(bytes.substr(i, 100));
    x.give();
  }
  x.read(100);
  if (x.peer())
    std::abort();
}

} // namespace

/// Frames of a handshake, at either end.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  static const known_site site;
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  tls_engine accepting{site.settings, tls_engine::role::accepts};
  let_in(accepting, bytes);
  tls_engine connecting{site.settings, tls_engine::role::connects};
  let_in(connecting, bytes);
  return 0;
}
