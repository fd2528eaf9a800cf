#include "tools/roscell/ros2/echo/message_value.hpp"

#include <cstdint>
#include <iterator>

/// What `roscell echo` makes of a message that an unauthenticated peer has
/// sent. The first byte chooses its type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size) {
  using namespace roscell::cli;
  if (size == 0)
    return 0;
  const auto& known = embedded_definitions();
  const auto type = std::next(known.begin(), data[0] % known.size())->first;
  const std::string payload{reinterpret_cast<const char*>(data) + 1, size - 1};
  static message_library library{{}};
  try {
    value_text(message_value(library, type, payload, 8));
  } catch (const definition_error&) {
    // Refused, as it should be.
  }
  return 0;
}
