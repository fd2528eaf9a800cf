#include "skills/engine/life/environment_watch.hpp"

#include "roscell/skill/errors.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include <string_view>
#include <utility>

namespace roscell::engine {

namespace {

constexpr std::size_t most_bytes = 64UL * 1024;

/// Empty for what is no such object: a node whose disk is full leaves half of
/// one, and starts the skill again.
changed_variables read_variables(std::string_view text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  changed_variables result;
  if (!document.is_object())
    return result;
  for (const auto& [name, value] : document.items()) {
    if (!value.is_string())
      return {};
    result[name] = value.get<std::string>();
  }
  return result;
}

} // namespace

environment_watch::environment_watch(const std::string& notify_socket,
                                     callback on_change)
    : on_change_(std::move(on_change)) {
  if (watch(notify_socket + ".environment"))
    thread_ = std::thread{[this] { run(); }};
}

environment_watch::~environment_watch() {
  stop_.set();
  if (thread_.joinable())
    thread_.join();
}

/// The lock comes last: whoever holds it hears all that is written.
bool environment_watch::watch(const std::string& path) {
  file_ = unique_fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (!file_)
    return false;
  try {
    changes_.emplace();
  } catch (const start_error&) {
    return false;
  }
  return changes_->add(path, IN_CLOSE_WRITE) >= 0
         && ::flock(file_.get(), LOCK_SH) == 0;
}

void environment_watch::run() {
  while (stop_.wait_readable(changes_->fd())) {
    changes_->read();
    take();
  }
}

/// The node writes to the same file again, so that the lock stays.
void environment_watch::take() {
  std::string text(most_bytes, '\0');
  const auto size = ::pread(file_.get(), text.data(), text.size(), 0);
  if (size <= 0)
    return;
  text.resize(static_cast<std::size_t>(size));
  auto told = read_variables(text);
  if (!told.empty())
    on_change_(std::move(told));
}

} // namespace roscell::engine
