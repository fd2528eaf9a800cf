#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_sighting.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// INTERNAL to this folder.
namespace roscell {

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
