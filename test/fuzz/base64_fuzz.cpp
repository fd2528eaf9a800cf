#include "schemas/utf8.hpp"

#include <cstdint>
#include <cstdlib>
#include <string_view>

/// What is read is the same again when it is written, but for bits that no byte
/// has, and each text of bytes comes back.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  if (roscell::from_base64(roscell::to_base64(bytes)) != std::string{bytes})
    std::abort();
  const auto read = roscell::from_base64(bytes);
  if (read && roscell::from_base64(roscell::to_base64(*read)) != *read)
    std::abort();
  return 0;
}
