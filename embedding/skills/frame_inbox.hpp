#pragma once

#include "roscell/actor_skill.hpp"
#include "roscell/skill/handlers.hpp"

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace roscell::embedding {

using shared_frame = std::shared_ptr<const engine::frame>;

/// What one lane may hold. A larger frame still fits into an empty lane.
struct inbox_limits {
  std::size_t frames = 8;
  std::size_t bytes = 64UL * 1024 * 1024;
};

/// What waits for one instance: a bounded lane for each input, which take
/// turns. Frames come from any thread; the instance's keeper takes them out.
class frame_inbox {
public:
  /// `wake` is called, from the thread of a push, when a frame has come after
  /// `pop` had found nothing.
  frame_inbox(std::size_t ports, inbox_limits lane_limits,
              std::function<void()> wake);

  /// Where there is no room the oldest frame of the port is dropped, or the
  /// caller waits. False once the inbox is closed.
  bool push(std::size_t port, shared_frame x, engine::when_full policy);

  /// The next frame, or nothing; then the next push wakes.
  std::optional<skill_frame> pop();

  /// Lets nothing in or out any more.
  void close();

  std::uint64_t dropped() const;

private:
  struct lane {
    std::deque<skill_frame> frames;
    std::size_t bytes = 0;
    std::uint64_t next_sequence = 0;
  };

  bool has_room(const lane& x, std::size_t bytes) const;
  static skill_frame take_oldest(lane& from);

  const inbox_limits limits_;
  const std::function<void()> wake_;
  mutable std::mutex mutex_; // Guards what follows.
  std::condition_variable room_;
  std::vector<lane> lanes_;
  std::size_t turn_ = 0;
  std::uint64_t dropped_ = 0;
  bool idle_ = true;
  bool closed_ = false;
};

/// The protocol "actor": frames that instances of one process pass on to each
/// other by pointer. May be used from any thread.
class frame_hub {
public:
  /// From now on the frames of `stream` go to that port. Ends with the inbox.
  void subscribe(const std::string& stream,
                 const std::shared_ptr<frame_inbox>& inbox, std::size_t port);

  void publish(const std::string& stream, const shared_frame& x);

private:
  struct reader {
    std::weak_ptr<frame_inbox> inbox;
    std::size_t port;
  };

  std::mutex mutex_;
  std::map<std::string, std::vector<reader>> readers_;
};

} // namespace roscell::embedding
