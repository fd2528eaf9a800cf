#pragma once

#include "actors/edge/dds/discovery_address.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// Introduces a discovery server to another one until that one is known. Fast
/// DDS by itself does so ten times a second, for ever, to each server that it
/// has ever been told of. Has a thread of its own, which sleeps meanwhile.
class introducer {
public:
  /// Between two introductions; each pause is twice as long as the one before.
  static constexpr std::chrono::milliseconds first_pause{50};
  static constexpr std::chrono::milliseconds longest_pause{2000};

  /// Messages leave from the socket's address.
  explicit introducer(udp_socket socket);
  ~introducer();

  introducer(const introducer&) = delete;
  introducer& operator=(const introducer&) = delete;

  /// The message that introduces. Without one nothing is sent.
  void set_words(std::vector<std::uint8_t> words);

  /// Until `rest`, beginning after that time.
  void seek(const sockaddr_in& server, std::chrono::milliseconds after);

  /// It is known, or not wanted any more.
  void rest();

private:
  void run();

  const udp_socket socket_;
  std::mutex mutex_; // Guards what follows.
  std::vector<std::uint8_t> words_;
  std::condition_variable changed_;
  bool closing_ = false;
  bool seeks_ = false;
  bool anew_ = false; // Somebody has asked to begin.
  std::chrono::milliseconds pause_ = first_pause;
  sockaddr_in server_{};
  std::thread thread_;
};

} // namespace roscell
