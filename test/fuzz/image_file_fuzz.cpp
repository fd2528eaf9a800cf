#include "skills/vision/image_codec.hpp"

#include <cstdint>
#include <cstdlib>
#include <optional>

using namespace roscell::vision;

namespace {

std::optional<picture> decode(std::string_view file, pixel_format wanted) {
  try {
    return decode_picture(file, wanted);
  } catch (const image_error&) {
    return std::nullopt;
  }
}

} // namespace

/// Whatever is in a file, it gives a picture of the size it says, which can be
/// written and read again, or an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  const std::string_view file{reinterpret_cast<const char*>(data), size};
  for (auto wanted : {pixel_format::mono8, pixel_format::bgr8}) {
    const auto first = decode(file, wanted);
    if (!first)
      continue;
    if (first->pixels.size() != first->step() * first->height
        || first->format != wanted)
      std::abort();
    // Writing large ones would make the fuzzer slow.
    if (first->pixels.size() > 65536)
      continue;
    const auto second = decode(encode_png(*first), wanted);
    if (!second || second->pixels != first->pixels)
      std::abort();
  }
  return 0;
}
