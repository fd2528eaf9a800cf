#pragma once

#include "roscell/skill/safe_state.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/liveness.hpp"
#include "skills/engine/life/notify_socket.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Tells the node twice per watchdog period that the skill is ready and alive,
/// for as long as its liveness allows. READY=1 is repeated so that a node
/// that was restarted learns of it, and so is what the author has said of the
/// skill's safety. At most once a second the skill's status goes along. Owns
/// one thread, which only wakes for a heartbeat or for a word on safety.
class heartbeat {
public:
  /// What goes along with a heartbeat; each is called from the heartbeat's
  /// thread.
  struct words {
    /// "STATUS=..." for people and for the node, and lines that go along.
    std::function<std::string()> status;
    /// What the streams do, see stream_meters; empty: nobody wants to know.
    /// With it there is a heartbeat at least every second.
    std::function<std::string(liveness::clock::time_point now)> streams;
  };

  /// A skill that says more often whether it is stop-safe is not heard more
  /// often: of what it says meanwhile the last word is sent.
  static constexpr std::chrono::milliseconds least_word_pause{50};

  /// Metrics are not taken over a shorter time.
  static constexpr std::chrono::milliseconds least_stream_pause{500};

  /// The references must outlive this object.
  heartbeat(const notify_socket& socket, liveness& alive, safe_state& safety,
            words reported);

  /// Ends the heartbeat.
  ~heartbeat();

  /// Makes up for a heartbeat that was withheld, see liveness::work_ends.
  void send_now() noexcept;

private:
  using time_point = liveness::clock::time_point;

  void run();
  void send_heartbeat(time_point now);
  void report_safety(time_point now);
  std::string safety_line();

  const notify_socket& socket_;
  liveness& alive_;
  safe_state& safety_;
  const words words_;
  time_point last_status_;
  time_point last_streams_;
  std::optional<bool> reported_safety_;
  time_point safety_quiet_until_;
  unique_fd timer_;
  unique_fd wake_;
  stop_event stop_;
  std::thread thread_;
};

} // namespace roscell::engine
