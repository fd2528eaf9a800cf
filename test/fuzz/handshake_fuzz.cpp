#include "actors/edge/session/session_handshake.hpp"

#include <cstdlib>
#include <string_view>

/// Both sides of the handshake are fed frames of an unauthenticated peer: the
/// input, cut at zero bytes. Neither may ever come to believe in a session.
extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, size_t size) {
  using namespace roscell;
  const std::string nonce(64, '0');
  acceptor_handshake acceptor{{"base", "ffff", "kitchen", 3}, "token", nonce};
  joiner_handshake joiner{{"robot", "0a1b", 7}, "token", {}, nonce};
  joiner_handshake coordinator{
      {"hall", "0a1c", 7, "coordinator"}, "token", {}, nonce};
  std::string_view rest{reinterpret_cast<const char*>(data), size};
  while (true) {
    const auto frame = rest.substr(0, rest.find('\0'));
    if (acceptor.receive(frame).done || joiner.receive(frame).done
        || coordinator.receive(frame).done)
      std::abort();
    if (frame.size() == rest.size())
      return 0;
    rest.remove_prefix(frame.size() + 1);
  }
}
