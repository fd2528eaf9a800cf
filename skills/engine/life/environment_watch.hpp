#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/file/inotify_watch.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Hears, on a thread of its own, that the cell is to be found elsewhere: where
/// this host has got another address the node writes variables with their new
/// values, as a JSON object of texts, into the file
/// `$NOTIFY_SOCKET.environment` that it has made. While there is a listener it
/// holds a shared lock (flock(2)) on the file: by that the node knows that
/// somebody reads it.
class environment_watch {
public:
  using callback = std::function<void(changed_variables)>;

  /// Hears nothing where there is no such file, or it cannot be watched: the
  /// node then starts the skill again.
  environment_watch(const std::string& notify_socket, callback on_change);

  /// There are no calls after it.
  ~environment_watch();

private:
  bool watch(const std::string& path);
  void run();
  void take();

  const callback on_change_;
  std::optional<inotify_watch> changes_;
  unique_fd file_;
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
