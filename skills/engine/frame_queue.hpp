#pragma once

#include "roscell/skill/frame.hpp"
#include "roscell/skill/handlers.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <vector>

namespace roscell::engine {

/// Stands between the inputs and the executor. Each input port has a lane of
/// its own, so that a fast input cannot push out the frames of a slow one;
/// lanes take turns at the other end.
class frame_queue : public frame_sink {
public:
  /// Bounds of each lane. A frame larger than `max_bytes` still fits into an
  /// empty lane.
  struct limits {
    std::size_t max_frames;
    std::size_t max_bytes;
  };

  frame_queue(std::size_t lanes, limits lane_limits);

  /// Puts the frame into lane `input.port`.
  bool push(frame input, when_full policy) override;

  /// Waits for a frame. Returns nothing when the queue is closed and empty.
  std::optional<frame> pop();

  /// Has the thread that waits in `pop`, or the one that calls it next, do
  /// `work` before it takes a frame. Of several that wait the last one is done;
  /// none is once the queue is closed.
  void interpose(std::function<void()> work);

  /// Takes no more frames. Those inside are still handed out.
  void close();

  /// Takes no more frames and throws away, uncounted, those inside.
  void discard();

  /// How many frames of lane `port` were dropped for newer ones.
  std::uint64_t dropped(std::size_t port) const;

private:
  struct lane {
    std::deque<frame> frames;
    std::size_t bytes = 0;
    std::uint64_t dropped = 0;
  };

  bool has_room(const lane& l, std::size_t bytes) const;
  frame take_front(lane& l);
  lane* next_filled_lane();
  void do_interposed(std::unique_lock<std::mutex>& guard);

  const limits limits_;
  mutable std::mutex mutex_;
  std::condition_variable room_;
  std::condition_variable filled_;
  std::vector<lane> lanes_;
  std::size_t turn_ = 0;
  std::function<void()> interposed_;
  bool closed_ = false;
};

} // namespace roscell::engine
