#pragma once

#include "actors/edge/dds/discovery_sighting.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace roscell {

struct server_inquiry_options {
  std::string server_address;        ///< IPv4 address of the discovery server.
  std::uint16_t server_port = 11811; ///< UDP.
  /// The local IPv4 address to use; empty for the one that reaches the server.
  std::string address;
};

/// The server has answered, with another announcement than before. Called on
/// the inquiry's thread, which must not be called from there.
using on_server_found = std::function<void(const server_sighting&)>;

/// Asks one address who serves discovery there, until it is closed: with 20 ms
/// between the first questions, then with growing pauses up to `longest_pause`,
/// which is the pause after an answer, too. That costs about 140 B/s, and the
/// server keeps nothing of who asks (rtps/discovery_probe.hpp). A CLIENT of
/// Fast DDS would send up to 34 kB/s to an address where nobody is, and the
/// server would tell all others of it.
class server_inquiry {
public:
  static constexpr std::chrono::milliseconds longest_pause{2000};

  /// Starts to ask; never waits for an answer. Refused with `unreachable` (no
  /// such local address, or no route) or `schema_violation` (an option is out
  /// of bounds).
  static edge_result<std::unique_ptr<server_inquiry>>
  open(const server_inquiry_options& options, on_server_found callback);

  /// Calls `close`.
  ~server_inquiry();

  server_inquiry(const server_inquiry&) = delete;
  server_inquiry& operator=(const server_inquiry&) = delete;

  /// The callback is not called any more when it returns.
  void close();

private:
  class impl;
  explicit server_inquiry(std::unique_ptr<impl> x);
  std::unique_ptr<impl> impl_;
};

} // namespace roscell
