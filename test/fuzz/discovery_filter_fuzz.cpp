#include "actors/edge/dds/lives/discovery_guard.hpp"
#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "actors/edge/dds/rtps/participant_news.hpp"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <vector>

namespace {

/// What it let pass once passes unchanged. How it came does not decide whether
/// it passes.
bool check(std::vector<std::uint8_t> bytes, roscell::arrival how) {
  if (!roscell::make_safe(bytes.data(), bytes.size(), how))
    return false;
  auto again = bytes;
  if (!roscell::make_safe(again.data(), again.size(), how) || again != bytes)
    std::abort();
  return true;
}

/// What is safe stays so on its way through the guard, in either direction.
void guard(std::vector<std::uint8_t> bytes) {
  static roscell::discovery_guard guard{
      3, std::make_shared<roscell::number_reserve>(),
      std::get<roscell::udp_socket>(roscell::udp_socket::bind("127.0.0.1", 0))};
  if (!roscell::make_safe(bytes.data(), bytes.size()))
    return;
  if (guard.take_in(bytes.data(), bytes.size(), sockaddr_in{})
      && !roscell::make_safe(bytes.data(), bytes.size()))
    std::abort();
  guard.let_out(bytes.data(), bytes.size());
}

} // namespace

/// Reads in bounds.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  std::vector<std::uint8_t> bytes{data, data + size};
  if (check(bytes, roscell::arrival::direct)
      != check(bytes, roscell::arrival::multicast))
    std::abort();
  guard(bytes);
  roscell::own_announcement_in(bytes.data(), bytes.size());
  return 0;
}
