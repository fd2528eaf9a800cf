#include "actors/edge/trust/handshake_thread.hpp"

#include "actors/edge/trust/limits.hpp"

#include <pthread.h>

#include <csignal>
#include <exception>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

/// A thread that takes no signals: they belong to others.
std::thread start_quiet(std::function<void()> body) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread result{[body = std::move(body)] {
      pthread_setname_np(pthread_self(), "roscell-hands");
      body();
    }};
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return result;
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
}

} // namespace

handshake_thread::~handshake_thread() {
  {
    const std::lock_guard guard{mutex_};
    ending_ = true;
    jobs_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable())
    thread_.join();
}

void handshake_thread::run(std::function<void()> job) {
  const std::lock_guard guard{mutex_};
  if (ending_)
    return;
  jobs_.push_back(std::move(job));
  if (std::exchange(working_, true))
    return changed_.notify_one();
  // One that has decided to end does nothing more with this object.
  if (thread_.joinable())
    thread_.join();
  try {
    thread_ = start_quiet([this] { work(); });
  } catch (const std::system_error&) {
    // Later there may be room for one; who waits has a time limit.
    working_ = false;
  }
}

/// Takes the next job; false: there has been none for a while.
bool handshake_thread::next(std::unique_lock<std::mutex>& guard,
                            std::function<void()>& job) {
  const bool more =
      changed_.wait_for(guard, limits::trust::idle_thread,
                        [this] { return ending_ || !jobs_.empty(); });
  if (!more || ending_)
    return false;
  job = std::move(jobs_.front());
  jobs_.pop_front();
  return true;
}

void handshake_thread::work() {
  std::function<void()> job;
  std::unique_lock guard{mutex_};
  while (next(guard, job)) {
    guard.unlock();
    try {
      job();
    } catch (const std::exception&) {
      // Whoever waits for it has a time limit.
    }
    job = nullptr;
    guard.lock();
  }
  working_ = false;
}

} // namespace roscell
