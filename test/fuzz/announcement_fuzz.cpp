#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/limits.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

/// Whatever decodes must survive its own encoding, unless that is too long.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  roscell::probe_answer(data, size);
  auto read = roscell::decode({reinterpret_cast<const char*>(data), size});
  if (!read)
    return 0;
  auto written = roscell::encode(*read);
  auto again = roscell::decode(written);
  if (written.size() <= roscell::limits::discovery::announcement_bytes
      && again != read)
    std::abort();
  return 0;
}
