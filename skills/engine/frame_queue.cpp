#include "skills/engine/frame_queue.hpp"

#include <utility>

namespace roscell::engine {

frame_queue::frame_queue(std::size_t lanes, limits lane_limits)
    : limits_(lane_limits), lanes_(lanes) {
  // nop
}

bool frame_queue::push(frame input, when_full policy) {
  std::unique_lock guard{mutex_};
  auto& l = lanes_.at(input.port);
  auto bytes = input.payload.size();
  if (policy == when_full::wait)
    room_.wait(guard, [&] { return closed_ || has_room(l, bytes); });
  if (closed_)
    return false;
  while (!has_room(l, bytes)) {
    take_front(l);
    ++l.dropped;
  }
  l.bytes += bytes;
  l.frames.push_back(std::move(input));
  filled_.notify_one();
  return true;
}

std::optional<frame> frame_queue::pop() {
  std::unique_lock guard{mutex_};
  lane* next = nullptr;
  filled_.wait(guard, [&] {
    do_interposed(guard);
    next = next_filled_lane();
    return next != nullptr || closed_;
  });
  if (next == nullptr)
    return std::nullopt;
  auto result = take_front(*next);
  // Inputs of different lanes wait on the same condition.
  room_.notify_all();
  return result;
}

void frame_queue::do_interposed(std::unique_lock<std::mutex>& guard) {
  while (interposed_ && !closed_) {
    const auto work = std::exchange(interposed_, nullptr);
    // It may take a while, and inputs go on.
    guard.unlock();
    work();
    guard.lock();
  }
}

void frame_queue::interpose(std::function<void()> work) {
  std::lock_guard guard{mutex_};
  interposed_ = std::move(work);
  filled_.notify_one();
}

void frame_queue::close() {
  std::lock_guard guard{mutex_};
  closed_ = true;
  room_.notify_all();
  filled_.notify_all();
}

void frame_queue::discard() {
  std::lock_guard guard{mutex_};
  closed_ = true;
  for (auto& l : lanes_) {
    l.frames.clear();
    l.bytes = 0;
  }
  room_.notify_all();
  filled_.notify_all();
}

std::uint64_t frame_queue::dropped(std::size_t port) const {
  std::lock_guard guard{mutex_};
  return lanes_.at(port).dropped;
}

bool frame_queue::has_room(const lane& l, std::size_t bytes) const {
  return l.frames.empty()
         || (l.frames.size() < limits_.max_frames && bytes <= limits_.max_bytes
             && l.bytes <= limits_.max_bytes - bytes);
}

frame frame_queue::take_front(lane& l) {
  auto result = std::move(l.frames.front());
  l.frames.pop_front();
  l.bytes -= result.payload.size();
  return result;
}

frame_queue::lane* frame_queue::next_filled_lane() {
  for (std::size_t i = 0; i < lanes_.size(); ++i) {
    auto& l = lanes_[(turn_ + i) % lanes_.size()];
    if (!l.frames.empty()) {
      turn_ = (turn_ + i + 1) % lanes_.size();
      return &l;
    }
  }
  return nullptr;
}

} // namespace roscell::engine
