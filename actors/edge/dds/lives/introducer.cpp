#include "actors/edge/dds/lives/introducer.hpp"

#include <algorithm>
#include <utility>

#include <sys/socket.h>

namespace roscell {

introducer::introducer(udp_socket socket)
    : socket_(std::move(socket)), thread_([this] { run(); }) {}

introducer::~introducer() {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void introducer::set_words(std::vector<std::uint8_t> words) {
  std::lock_guard<std::mutex> lock{mutex_};
  words_ = std::move(words);
}

void introducer::seek(const sockaddr_in& server,
                      std::chrono::milliseconds after) {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    server_ = server;
    seeks_ = true;
    anew_ = true;
    pause_ = after;
  }
  changed_.notify_one();
}

void introducer::rest() {
  std::lock_guard<std::mutex> lock{mutex_};
  seeks_ = false;
}

void introducer::run() {
  std::unique_lock<std::mutex> lock{mutex_};
  while (!closing_) {
    changed_.wait(lock, [this] { return closing_ || seeks_; });
    anew_ = false;
    // Woken early by whoever closes, or asks to begin anew.
    if (changed_.wait_for(lock, pause_, [this] { return closing_ || anew_; })
        || !seeks_)
      continue;
    sendto(socket_.fd(), words_.data(), words_.size(), MSG_NOSIGNAL,
           reinterpret_cast<const sockaddr*>(&server_), sizeof(server_));
    pause_ = std::clamp(2 * pause_, first_pause, longest_pause);
  }
}

} // namespace roscell
