#pragma once

#include "actors/edge/dds/dds_thread.hpp"
#include "actors/edge/dds/discovery_address.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// Introduces a discovery server to another one until that one is known. Fast
/// DDS by itself does so ten times a second, for ever, to each server that it
/// has ever been told of.
class introducer {
public:
  /// Between two introductions; each pause is twice as long as the one before.
  static constexpr std::chrono::milliseconds first_pause{50};
  static constexpr std::chrono::milliseconds longest_pause{2000};

  /// Messages leave from the socket's address.
  explicit introducer(udp_socket socket);

  introducer(const introducer&) = delete;
  introducer& operator=(const introducer&) = delete;

  /// The message that introduces. Without one nothing is sent.
  void set_announcement(std::vector<std::uint8_t> words);

  /// Until `rest`, beginning after that time.
  void seek(const sockaddr_in& server, std::chrono::milliseconds after);

  /// It is known, or not wanted any more.
  void rest();

private:
  /// After `pause_`. Under the lock.
  void await();
  void on_ring();

  const udp_socket socket_;
  std::mutex mutex_; // Guards what follows.
  std::vector<std::uint8_t> announcement_;
  bool seeks_ = false;
  std::chrono::milliseconds pause_ = first_pause;
  dds_thread::clock::time_point due_{};
  sockaddr_in server_{};
  const std::unique_ptr<dds_thread::entry> timer_; // Uses all the others.
};

} // namespace roscell
