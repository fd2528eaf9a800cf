#include "actors/edge/dds/lives/introducer.hpp"

#include <algorithm>
#include <utility>

#include <sys/socket.h>

namespace roscell {

introducer::introducer(udp_socket socket)
    : socket_(std::move(socket)),
      timer_(dds_thread::shared()->make_timer([this] { on_ring(); })) {
  // nop
}

void introducer::set_announcement(std::vector<std::uint8_t> words) {
  std::lock_guard<std::mutex> lock{mutex_};
  announcement_ = std::move(words);
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
