#include "tools/roscell/progress.hpp"

#include "tools/roscell/event_stream.hpp"
#include "tools/roscell/terminal.hpp"

#include <utility>

namespace roscell::cli {

progress::progress(const node_client& node, std::string task)
    : task_{std::move(task)}, reader_{[this, &node] { read(node); }} {}

progress::~progress() {
  cancel_.cancel();
  reader_.join();
}

void progress::begin() {
  const std::lock_guard guard{mutex_};
  begun_ = true;
  for (const auto& line : held_)
    print_note(line);
  held_.clear();
}

void progress::read(const node_client& node) {
  const auto tell_of = [this](const event& e) {
    for (const auto& line : progress_lines(e, task_))
      tell(line);
    return true;
  };
  try {
    follow_events(node, from_now_on, tell_of, &cancel_);
  } catch (const std::runtime_error&) {
    // The request itself meets the same trouble and tells of it.
    return;
  }
}

void progress::tell(const std::string& line) {
  const std::lock_guard guard{mutex_};
  if (begun_)
    print_note(line);
  else
    held_.push_back(line);
}

} // namespace roscell::cli
