#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace roscell {

/// Where handshakes are computed, so that no socket and no actor waits for
/// them: one job after another, on a thread that is there while there is work
/// and a little longer. From any thread.
class handshake_thread {
public:
  handshake_thread() = default;

  /// Waits for the job that runs. Those that wait are dropped.
  ~handshake_thread();

  handshake_thread(const handshake_thread&) = delete;
  handshake_thread& operator=(const handshake_thread&) = delete;

  /// A job that throws is dropped.
  void run(std::function<void()> job);

private:
  void work();
  bool next(std::unique_lock<std::mutex>& guard, std::function<void()>& job);

  std::mutex mutex_; // Guards what follows.
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::thread thread_;
  bool working_ = false; ///< The thread has not decided to end.
  bool ending_ = false;
};

} // namespace roscell
