#include "embedding/skills/frame_inbox.hpp"

#include <algorithm>
#include <utility>

namespace roscell::embedding {

frame_inbox::frame_inbox(std::size_t ports, inbox_limits lane_limits,
                         std::function<void()> wake)
    : limits_(lane_limits), wake_(std::move(wake)), lanes_(ports) {}

bool frame_inbox::has_room(const lane& x, std::size_t bytes) const {
  return x.frames.empty()
         || (x.frames.size() < limits_.frames
             && x.bytes + bytes <= limits_.bytes);
}

skill_frame frame_inbox::take_oldest(lane& from) {
  auto result = std::move(from.frames.front());
  from.frames.pop_front();
  from.bytes -= result.data->payload.size();
  return result;
}

bool frame_inbox::push(std::size_t port, shared_frame x,
                       engine::when_full policy) {
  const auto bytes = x->payload.size();
  std::unique_lock<std::mutex> lock{mutex_};
  auto& to = lanes_.at(port);
  if (policy == engine::when_full::wait)
    room_.wait(lock, [&] { return closed_ || has_room(to, bytes); });
  if (closed_)
    return false;
  for (; !has_room(to, bytes); ++dropped_)
    take_oldest(to);
  to.frames.push_back({std::move(x), port, to.next_sequence++});
  to.bytes += bytes;
  const bool wakes = std::exchange(idle_, false);
  lock.unlock();
  if (wakes)
    wake_();
  return true;
}

std::optional<skill_frame> frame_inbox::pop() {
  std::lock_guard<std::mutex> lock{mutex_};
  for (std::size_t i = 0; !closed_ && i < lanes_.size(); ++i) {
    auto& from = lanes_[(turn_ + i) % lanes_.size()];
    if (from.frames.empty())
      continue;
    turn_ = (turn_ + i + 1) % lanes_.size();
    auto result = take_oldest(from);
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

void frame_hub::subscribe(const std::string& stream,
                          const std::shared_ptr<frame_inbox>& inbox,
                          std::size_t port) {
  std::lock_guard<std::mutex> lock{mutex_};
  // Readers come and go; what nobody reads any more is forgotten here.
  for (auto i = readers_.begin(); i != readers_.end();) {
    auto& all = i->second;
    all.erase(std::remove_if(all.begin(), all.end(),
                             [](const reader& x) { return x.inbox.expired(); }),
              all.end());
    i = all.empty() ? readers_.erase(i) : std::next(i);
  }
  readers_[stream].push_back({inbox, port});
}

void frame_hub::publish(const std::string& stream, const shared_frame& x) {
  std::vector<std::pair<std::shared_ptr<frame_inbox>, std::size_t>> to;
  {
    std::lock_guard<std::mutex> lock{mutex_};
    const auto i = readers_.find(stream);
    if (i == readers_.end())
      return;
    for (const auto& each : i->second)
      if (auto inbox = each.inbox.lock())
        to.emplace_back(std::move(inbox), each.port);
  }
  for (const auto& [inbox, port] : to)
    inbox->push(port, x, engine::when_full::drop_oldest);
}

} // namespace roscell::embedding
