#include "actors/edge/dds/herald.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

herald::herald(std::vector<milliseconds> delays, milliseconds pause,
               std::function<void()> say)
    : delays_(std::move(delays)), pause_(pause), say_(std::move(say)),
      next_(delays_.size()) {
  // nop
}

herald::~herald() {
  stop();
}

void herald::start() {
  auto timer = dds_thread::shared()->make_timer([this] { on_ring(); });
  const std::lock_guard lock{mutex_};
  timer_ = std::move(timer);
  if (std::exchange(asked_, false))
    await(0);
}

void herald::ask() {
  const std::lock_guard lock{mutex_};
  if (!timer_ || speaks_)
    asked_ = true;
  else if (next_ != 0)
    // Who asks during a later delay need not wait for its end.
    await(0);
}

void herald::stop() {
  std::unique_ptr<dds_thread::entry> ended;
  {
    const std::lock_guard lock{mutex_};
    ended = std::move(timer_);
  }
  // Ends here, unlocked: it waits for `on_ring`.
}

void herald::await(std::size_t which) {
  next_ = which;
  due_ = std::max(clock::now() + delays_[which], last_ + pause_);
  timer_->call_at(due_);
}

void herald::on_ring() {
  {
    const std::lock_guard lock{mutex_};
    // Somebody may have asked for another time meanwhile.
    if (!timer_ || next_ == delays_.size() || clock::now() < due_)
      return;
    speaks_ = true;
  }
  say_();
  const std::lock_guard lock{mutex_};
  speaks_ = false;
  last_ = clock::now();
  ++next_;
  if (!timer_)
    return;
  if (std::exchange(asked_, false))
    await(0);
  else if (next_ < delays_.size())
    await(next_);
}

} // namespace roscell
