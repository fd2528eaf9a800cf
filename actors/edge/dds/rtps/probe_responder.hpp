#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "dds/server_addresses.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// INTERNAL to actors/edge/dds: both ends of the question whether a discovery
/// server is there. A `probe_responder` answers it in a server's place; a
/// `server_readiness` asks it of a server of this process that has just begun.
namespace roscell {

/// Answers those who ask for a discovery server (discovery_probe.hpp) in its
/// place. Fast DDS would take each of them for a client, and tell all other
/// servers of it: with 250 nodes that join at once, 250 times each question.
/// May be used by several threads.
class probe_responder {
public:
  /// So many who have asked last are remembered, so that nobody else hears
  /// their farewell.
  static constexpr std::size_t most_remembered = 1024;

  /// Answers leave from the socket's address.
  explicit probe_responder(udp_socket socket) : socket_(std::move(socket)) {}

  /// From now on it answers for this server.
  void speak_for(const guid_prefix& server, const std::string& announcement);

  /// Answers a question that has come from there. True: the message is of one
  /// who asks, and for nobody else. False until it knows whom it speaks for.
  bool take(std::uint8_t* message, std::size_t size, const sockaddr_in& from);

private:
  void remember(const guid_prefix& who);

  const udp_socket socket_;
  std::mutex mutex_; // Guards what follows.
  std::vector<std::uint8_t> reply_;
  std::set<guid_prefix> asked_;
  std::deque<guid_prefix> in_order_; // The same, the latest last.
};

/// Waits for a discovery server of this process to have entered itself into
/// its own database, which Fast DDS leaves to a thread, and learns with which
/// words it introduces itself.
///
/// We ask as a client does (discovery_probe.hpp): what the server says of
/// itself comes from that database.
class server_readiness {
public:
  /// `announce` has the server send its own data to all whom it knows; by
  /// itself it takes 110 ms until it does that for a newcomer.
  server_readiness(const sockaddr_in& server, std::function<void()> announce);

  /// Takes the questions back.
  ~server_readiness();

  server_readiness(const server_readiness&) = delete;
  server_readiness& operator=(const server_readiness&) = delete;

  /// The message with which it introduces itself to anybody. Blocks for `limit`
  /// at most; none when the server has not said by then who it is.
  std::optional<std::vector<std::uint8_t>>
  wait(std::chrono::milliseconds limit);

private:
  using clock = std::chrono::steady_clock;

  void send(const std::vector<std::uint8_t>& bytes);

  /// Until the server has told its own data, or `deadline`.
  std::optional<std::vector<std::uint8_t>> hear(clock::time_point deadline);

  sockaddr_in server_;
  std::function<void()> announce_;
  std::optional<udp_socket> socket_; // None: there is no free port.
  std::vector<guid_prefix> asked_;
};

} // namespace roscell
