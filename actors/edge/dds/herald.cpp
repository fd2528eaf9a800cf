#include "actors/edge/dds/herald.hpp"

#include <sys/socket.h>

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

introducer::introducer(udp_socket socket)
    : socket_(std::move(socket)),
      timer_(dds_thread::shared()->make_timer([this] { on_ring(); })) {
  // nop
}

void introducer::set_announcement(std::vector<std::uint8_t> message) {
  std::lock_guard<std::mutex> lock{mutex_};
  announcement_ = std::move(message);
}

void introducer::seek(const sockaddr_in& server,
                      std::chrono::milliseconds after) {
  std::lock_guard<std::mutex> lock{mutex_};
  server_ = server;
  seeks_ = true;
  pause_ = after;
  await();
}

void introducer::rest() {
  std::lock_guard<std::mutex> lock{mutex_};
  seeks_ = false;
}

void introducer::await() {
  due_ = dds_thread::clock::now() + pause_;
  timer_->call_at(due_);
}

void introducer::on_ring() {
  std::lock_guard<std::mutex> lock{mutex_};
  // Somebody may have asked for another time meanwhile.
  if (!seeks_ || dds_thread::clock::now() < due_)
    return;
  sendto(socket_.fd(), announcement_.data(), announcement_.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&server_), sizeof(server_));
  pause_ = std::clamp(2 * pause_, first_pause, longest_pause);
  await();
}

} // namespace roscell
