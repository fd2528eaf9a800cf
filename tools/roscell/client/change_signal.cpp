#include "tools/roscell/client/change_signal.hpp"

#include "tools/roscell/exit_code.hpp"

#include <string>
#include <utility>

namespace roscell::cli {

change_signal::change_signal(const node_client& node)
    : node_{node}, reader_{[this] { read(); }} {
  // nop
}

change_signal::~change_signal() {
  cancel_.cancel();
  reader_.join();
}

void change_signal::wait() {
  std::unique_lock guard{mutex_};
  news_.wait(guard, [this] { return has_news(); });
  take_news();
}

bool change_signal::wait_until(time_point limit) {
  std::unique_lock guard{mutex_};
  const bool result =
      news_.wait_until(guard, limit, [this] { return has_news(); });
  take_news();
  return result;
}

bool change_signal::has_news() const {
  return changed_ || ended_;
}

void change_signal::take_news() {
  changed_ = false;
  if (ended_)
    std::rethrow_exception(ended_);
}

void change_signal::read() {
  try {
    node_.follow(
        "/v1/events?since=" + std::to_string(from_now_on),
        [this](std::string_view line) { return on_line(line); }, &cancel_);
    throw command_error{exit_unreachable, "the node has ended the stream"};
  } catch (...) {
    const std::lock_guard guard{mutex_};
    ended_ = std::current_exception();
    news_.notify_one();
  }
}

bool change_signal::on_line(std::string_view line) {
  // The first line, a comment, says that nothing is missed from now on; what
  // happened since the first look is still to be seen.
  const bool opened = !std::exchange(open_, true);
  if (!events_.add_line(line) && !opened)
    return true;
  const std::lock_guard guard{mutex_};
  changed_ = true;
  news_.notify_one();
  return true;
}

} // namespace roscell::cli
