#pragma once

#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/liveness.hpp"
#include "skills/engine/life/notify_socket.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Tells the node twice per watchdog period that the skill is ready and alive,
/// for as long as its liveness allows. READY=1 is repeated so that a node
/// that was restarted learns of it. At most once a second the skill's status
/// goes along. Owns one thread, which only wakes for a beat.
class heartbeat {
public:
  /// Returns a one-line status for people and for the node.
  using status_function = std::function<std::string()>;

  /// The references must outlive this object.
  heartbeat(const notify_socket& socket, liveness& alive,
            status_function status);

  /// Ends the beat.
  ~heartbeat();

  /// Makes up for a beat that was withheld, see liveness::work_ends.
  void beat_now() noexcept;

private:
  void run();
  void beat();

  const notify_socket& socket_;
  liveness& alive_;
  status_function status_;
  liveness::clock::time_point last_status_;
  unique_fd timer_;
  unique_fd wake_;
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
