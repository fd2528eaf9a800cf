#include "actors/edge/dds/herald.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

herald::herald(std::vector<milliseconds> delays, milliseconds pause,
               std::function<void()> say)
    : delays_(std::move(delays)), pause_(pause), say_(std::move(say)) {
  // nop
}

herald::~herald() {
  stop();
}

void herald::start() {
  thread_ = std::thread{[this] { run(); }};
}

void herald::ask() {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    asked_ = true;
  }
  changed_.notify_one();
}

void herald::stop() {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    closing_ = true;
  }
  changed_.notify_one();
  if (thread_.joinable())
    thread_.join();
}

void herald::run() {
  auto next = delays_.size(); // The delay it waits for; idle behind the last.
  auto last = clock::now() - pause_;
  std::unique_lock<std::mutex> lock{mutex_};
  while (!closing_) {
    if (next == delays_.size()) {
      changed_.wait(lock, [this] { return closing_ || asked_; });
      next = 0;
    }
    if (std::exchange(asked_, false))
      next = 0;
    // Who asks during a later delay need not wait for its end.
    auto woken = [&] { return closing_ || (asked_ && next > 0); };
    auto due = std::max(clock::now() + delays_[next], last + pause_);
    if (changed_.wait_until(lock, due, woken))
      continue;
    asked_ = false;
    ++next;
    lock.unlock();
    say_();
    last = clock::now();
    lock.lock();
  }
}

} // namespace roscell
