#pragma once

#include "actors/edge/dds/dds_thread.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

/// INTERNAL to this folder.
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

} // namespace roscell
