#include "embedding/skills/frame_inbox.hpp"

#include <utility>

namespace roscell::embedding {

frame_inbox::frame_inbox(std::size_t ports, std::size_t most_frames,
                         std::function<void()> wake)
    : most_frames_(most_frames), wake_(std::move(wake)), lanes_(ports) {}

bool frame_inbox::push(std::size_t port, shared_frame x,
                       engine::when_full policy) {
  std::unique_lock<std::mutex> lock{mutex_};
  auto& to = lanes_.at(port);
  if (policy == engine::when_full::wait)
    room_.wait(lock,
               [&] { return closed_ || to.frames.size() < most_frames_; });
  if (closed_)
    return false;
  if (to.frames.size() >= most_frames_) {
    to.frames.pop_front();
    ++dropped_;
  }
  to.frames.push_back({std::move(x), port, to.next_sequence++});
  const bool wakes = std::exchange(idle_, false);
  lock.unlock();
  if (wakes)
    wake_();
  return true;
}

std::optional<skill_frame> frame_inbox::pop() {
  std::lock_guard<std::mutex> lock{mutex_};
  for (std::size_t i = 0; !closed_ && i < lanes_.size(); ++i) {
    auto& from = lanes_[(turn_ + i) % lanes_.size()].frames;
    if (from.empty())
      continue;
    turn_ = (turn_ + i + 1) % lanes_.size();
    auto result = std::move(from.front());
    from.pop_front();
    room_.notify_all();
    return result;
  }
  idle_ = true;
  return std::nullopt;
}

void frame_inbox::close() {
  std::lock_guard<std::mutex> lock{mutex_};
  closed_ = true;
  lanes_.assign(lanes_.size(), {});
  room_.notify_all();
}

std::uint64_t frame_inbox::dropped() const {
  std::lock_guard<std::mutex> lock{mutex_};
  return dropped_;
}

} // namespace roscell::embedding
