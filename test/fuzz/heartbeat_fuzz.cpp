#include "actors/edge/reach/reach_port.hpp"
#include "actors/edge/session/heartbeat_packet.hpp"

#include <cstdlib>
#include <string_view>

/// A packet of an unauthenticated peer is never authentic, and reading it back
/// gives the bytes that were read. Nor is an unauthenticated peer answered who
/// wants to be reached.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  static const auto key = hmac_sha256("key", "of the fuzzer");
  const std::string_view bytes{reinterpret_cast<const char*>(data), size};
  if (reach_answer(bytes, "token of the fuzzer"))
    std::abort();
  const auto packet = read_heartbeat(bytes);
  if (!packet)
    return 0;
  const auto again = encode_heartbeat(*packet, key);
  if (bytes.substr(0, 8) != std::string_view{again.data(), 8})
    std::abort();
  if (is_authentic_heartbeat(bytes, key)
      != (bytes == std::string_view{again.data(), again.size()}))
    std::abort();
  return 0;
}
