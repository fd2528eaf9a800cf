#pragma once

#include "roscell/skill/safe_state.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <sys/un.h>

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace roscell::engine {

/// Decides whether a skill may still say that it is alive. It may while the
/// executor waits for a frame or began the current one less than half a
/// watchdog period ago. With heartbeats at every half period this means: work
/// that takes less than one period never looks hung, work that takes more than
/// one and a half always does. All members may be called from any thread.
class liveness {
public:
  using clock = std::chrono::steady_clock;

  /// `period` is the time after which the node takes a silent skill for hung.
  explicit liveness(clock::duration period) : period_(period) {
    // nop
  }

  void work_begins(clock::time_point now);

  /// Returns true when a heartbeat was withheld during this work; it is to be
  /// sent at once, because the next regular one may come too late.
  bool work_ends();

  /// Whether the heartbeat that is due `now` may be sent.
  bool allows_heartbeat(clock::time_point now);

  clock::duration period() const noexcept {
    return period_;
  }

private:
  const clock::duration period_;
  std::mutex mutex_;
  std::optional<clock::time_point> busy_since_;
  bool withheld_ = false;
};

/// Sends state to whoever supervises the skill, in the datagram protocol of
/// systemd's sd_notify(3).
class notify_socket {
public:
  /// `name` is the value of NOTIFY_SOCKET; if it is empty, nothing is ever
  /// sent. Throws start_error when it is no absolute path or abstract name.
  explicit notify_socket(const std::string& name);

  bool enabled() const noexcept {
    return static_cast<bool>(fd_);
  }

  /// Sends e.g. "READY=1". Waits at most one second for a receiver that is
  /// behind. Returns 0 or an errno: a node that restarts has no socket for a
  /// while, which is no reason for a skill to stop.
  int send(const std::string& state) const;

private:
  unique_fd fd_;
  sockaddr_un address_{};
  unsigned address_size_ = 0;
};

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
