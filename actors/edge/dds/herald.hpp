#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

/// INTERNAL to this folder.
namespace roscell {

/// Says the same thing again after somebody asked for it, so that whoever
/// missed it the first time hears it. Many who ask at once are served together.
/// Has a thread of its own, which sleeps until it is asked.
class herald {
public:
  using milliseconds = std::chrono::milliseconds;

  /// Once asked, it calls `say` after each of `delays` in turn; it starts anew
  /// when it is asked meanwhile, and keeps `pause` between any two calls.
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

  void run();

  const std::vector<milliseconds> delays_;
  const milliseconds pause_;
  const std::function<void()> say_;
  std::mutex mutex_; // Guards what follows.
  std::condition_variable changed_;
  bool closing_ = false;
  bool asked_ = false;
  std::thread thread_;
};

} // namespace roscell
