#pragma once

#include "actors/edge/dds/dds_thread.hpp"
#include "actors/edge/dds/discovery_address.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

/// INTERNAL to this folder: what a participant says again without being asked
/// anew. A `herald` repeats an announcement after it was asked for; an
/// `introducer` repeats a server's introduction to another one until that is
/// known. Each owns a timer on the DDS thread; failures to send are ignored,
/// because the next repetition follows.
namespace roscell {

/// Says the same thing again after somebody asked for it, so that whoever
/// missed it the first time hears it. Many who ask at once are served together.
class herald {
public:
  using milliseconds = std::chrono::milliseconds;

  /// Once asked, it calls `say`, on the DDS thread, after each of `delays` in
  /// turn; it starts anew when it is asked meanwhile, and keeps `pause` between
  /// any two calls.
  herald(std::vector<milliseconds> delays, milliseconds pause,
         std::function<void()> say);

  /// Calls `stop`.
  ~herald();

  herald(const herald&) = delete;
  herald& operator=(const herald&) = delete;

  /// From here on it serves who asks, and who has asked before. Called once.
  void start();

  /// May be called from any thread, and does not wait.
  void ask();

  /// `say` is not called any more when it returns. Not to be called by `say`.
  void stop();

private:
  using clock = std::chrono::steady_clock;

  /// Has the timer ring after delay `which`. Under the lock.
  void await(std::size_t which);

  void on_ring();

  const std::vector<milliseconds> delays_;
  const milliseconds pause_;
  const std::function<void()> say_;
  std::mutex mutex_; // Guards what follows.
  bool asked_ = false;
  bool speaks_ = false;  // `say` is being called.
  std::size_t next_ = 0; // The delay it waits for; idle behind the last.
  clock::time_point due_{};
  clock::time_point last_{};
  std::unique_ptr<dds_thread::entry> timer_; // Null: it does not serve.
};

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
  void set_announcement(std::vector<std::uint8_t> message);

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
