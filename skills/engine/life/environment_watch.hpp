#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Hears, on a thread of its own, that the cell is to be found elsewhere: where
/// this host has got another address the node writes variables with their new
/// values, as a JSON object of texts on a line, into the FIFO
/// `$NOTIFY_SOCKET.environment` that it has made. By its having a reader the
/// node knows that somebody listens.
class environment_watch {
public:
  using callback = std::function<void(changed_variables)>;

  /// Hears nothing where there is no such FIFO: the node then starts the skill
  /// again.
  environment_watch(const std::string& notify_socket, callback on_change);

  /// There are no calls after it.
  ~environment_watch();

private:
  void run();
  void take();
  void obey(const std::string& line);

  const callback on_change_;
  unique_fd fifo_;
  std::string heard_; ///< Of a line that has not ended.
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
