#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// INTERNAL to actors/edge/dds.
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

} // namespace roscell
