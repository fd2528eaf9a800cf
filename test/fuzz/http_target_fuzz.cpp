#include "actors/edge/http/http_target.hpp"

#include <cstdlib>
#include <string_view>

/// A path that was taken survives being encoded, and has no control bytes.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const auto target = parse_target({reinterpret_cast<const char*>(data), size});
  if (!target)
    return 0;
  const auto again = parse_target("/" + percent_encode(target->path));
  if (!again || again->path != "/" + target->path)
    std::abort();
  for (const char c : target->path)
    if (static_cast<unsigned char>(c) < 0x20)
      std::abort();
  return 0;
}
