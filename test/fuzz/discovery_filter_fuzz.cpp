#include "actors/edge/discovery_filter.hpp"

#include <cstdint>
#include <cstdlib>
#include <vector>

/// Reads in bounds, and what it let pass once passes unchanged.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  std::vector<std::uint8_t> bytes{data, data + size};
  if (!roscell::make_safe(bytes.data(), bytes.size()))
    return 0;
  auto again = bytes;
  if (!roscell::make_safe(again.data(), again.size()) || again != bytes)
    std::abort();
  return 0;
}
