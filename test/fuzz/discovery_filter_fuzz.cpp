#include "actors/edge/dds/rtps/discovery_filter.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <cstdint>
#include <cstdlib>
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

} // namespace

/// Reads in bounds.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  std::vector<std::uint8_t> bytes{data, data + size};
  if (check(bytes, roscell::arrival::direct)
      != check(bytes, roscell::arrival::multicast))
    std::abort();
  roscell::is_introduction(bytes.data(), bytes.size());
  return 0;
}
