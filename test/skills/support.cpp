#include "test/skills/support.hpp"

#include "roscell/skill/errors.hpp"

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>

namespace roscell::test {

bool collecting_sink::push(engine::frame input, engine::when_full policy) {
  std::lock_guard guard{mutex_};
  frames_.push_back(std::move(input));
  policies_.push_back(policy);
  grown_.notify_all();
  return true;
}

std::optional<engine::frame> collecting_sink::wait_for(std::size_t n) {
  std::unique_lock guard{mutex_};
  if (!grown_.wait_for(guard, patience, [&] { return frames_.size() > n; }))
    return std::nullopt;
  return frames_[n];
}

std::vector<engine::when_full> collecting_sink::policies() {
  std::lock_guard guard{mutex_};
  return policies_;
}

running_input::running_input(std::unique_ptr<engine::input_handler> handler)
    : handler_(std::move(handler)) {
  handler_->open();
  thread_ = std::thread{[this] {
    try {
      handler_->run(sink_, stop_);
    } catch (...) {
      outcome_ = engine::current_error();
    }
    ended_.set();
  }};
}

running_input::~running_input() {
  stop_.set();
  if (thread_.joinable())
    thread_.join();
}

std::string running_input::wait() {
  if (!ended_.wait_until(steady::now() + patience))
    return "the input did not end";
  thread_.join();
  return outcome_;
}

notify_receiver::notify_receiver(const std::string& name)
    : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address.sun_path);
  if (name.front() == '@')
    address.sun_path[0] = '\0';
  auto size = offsetof(sockaddr_un, sun_path) + name.size();
  if (::bind(fd_.get(), reinterpret_cast<sockaddr*>(&address),
             static_cast<socklen_t>(size))
      != 0)
    throw std::runtime_error("cannot bind " + name);
}

std::optional<std::string> notify_receiver::receive() {
  if (!wait_readable(fd_.get()))
    return std::nullopt;
  return receive_now();
}

std::optional<std::string> notify_receiver::receive_now() {
  char buffer[4096];
  auto n = ::recv(fd_.get(), buffer, sizeof(buffer), MSG_DONTWAIT);
  if (n < 0)
    return std::nullopt;
  return std::string{buffer, static_cast<std::size_t>(n)};
}

std::optional<std::string> notify_receiver::wait_for(const std::string& part) {
  auto deadline = steady::now() + patience;
  while (wait_readable(fd_.get(), deadline)) {
    auto state = receive_now();
    if (state && state->find(part) != std::string::npos)
      return state;
  }
  return std::nullopt;
}

} // namespace roscell::test
