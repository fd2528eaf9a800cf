#include "tools/roscell/client/change_signal.hpp"

#include <utility>

namespace roscell::cli {

// What happened since the first look is still to be seen once the events flow.
change_signal::change_signal(const node_client& node)
    : events_{
        lines_of(node),
        {[this](auto&&) { note(); }, [this](auto&&) { note(); },
         [this](const std::exception_ptr& why) {
           note(why ? why
                    : std::make_exception_ptr(command_error{
                        exit_unreachable, "the node has ended the stream"}));
           return false;
         }}} {}

bool change_signal::wait_until(time_point limit) {
  std::unique_lock guard{mutex_};
  const auto has_news = [this] { return changed_ || ended_ != nullptr; };
  // Not every clock can be waited for to its end.
  const bool result = limit == time_point::max()
                          ? (news_.wait(guard, has_news), true)
                          : news_.wait_until(guard, limit, has_news);
  changed_ = false;
  if (ended_)
    std::rethrow_exception(ended_);
  return result;
}

void change_signal::note(const std::exception_ptr& end) {
  const std::lock_guard guard{mutex_};
  changed_ = true;
  ended_ = end;
  news_.notify_one();
}

} // namespace roscell::cli
