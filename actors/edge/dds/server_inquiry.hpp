#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

// INTERNAL to this folder.

/// An event that another thread can raise and `poll` can wait for.
class wake_event {
public:
  wake_event();
  ~wake_event();
  wake_event(const wake_event&) = delete;
  wake_event& operator=(const wake_event&) = delete;

  int fd() const {
    return fd_;
  }

  void raise();

  /// Waits until it was raised, at most for `limit` unless that is negative,
  /// and takes it back. True when it was raised.
  bool wait(std::chrono::milliseconds limit);

private:
  int fd_;
};

/// Asks one address for the discovery server behind it, until it answers.
class server_seeker {
public:
  server_seeker(const sockaddr_in& server, std::string local_address,
                std::chrono::milliseconds max_interval)
      : server_(server), local_address_(std::move(local_address)),
        max_interval_(max_interval) {}

  /// Blocks until a server with a well-known prefix tells its own data, or
  /// until `wake` is raised: then it gives none, and `wake` is taken back. None
  /// also after a pause in which there was no socket to be had.
  std::optional<server_sighting> seek(wake_event& wake);

private:
  using clock = std::chrono::steady_clock;

  void ask(const udp_socket& socket);

  /// Waits for an answer until `deadline`; sets `woken` when `wake` was raised.
  std::optional<server_sighting> await(const udp_socket& socket,
                                       wake_event& wake,
                                       clock::time_point deadline, bool& woken);

  /// Reads all that has come.
  std::optional<server_sighting> receive(const udp_socket& socket);
  void answer(const udp_socket& socket, std::vector<std::uint8_t>& datagram);

  /// Takes the questions back, which a server of an earlier version remembers.
  void say_farewell(const udp_socket& socket);

  void send(const udp_socket& socket, const std::vector<std::uint8_t>& bytes);

  sockaddr_in server_;
  std::string local_address_;
  std::chrono::milliseconds max_interval_;
  std::deque<guid_prefix> asked_; // The latest, as those who asked.
  std::uint32_t answers_ = 0;     // To HEARTBEATs; a server counts them.
};

} // namespace roscell
