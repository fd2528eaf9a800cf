#pragma once

#include <chrono>
#include <functional>
#include <string_view>

/// The seam on the production path where tests lose, delay, repeat and cut
/// what passes between nodes. Without a filter everything passes.
namespace roscell {

enum class traffic_direction { outgoing, incoming };

/// What becomes of one frame or packet.
struct traffic_verdict {
  enum class action {
    pass,
    drop,   ///< It is lost.
    delay,  ///< It comes later, and so behind what follows it.
    repeat, ///< It comes `times` times in a row.
    cut,    ///< It is lost, and the connection with it. For a heartbeat: drop.
  };

  action what = action::pass;
  std::chrono::milliseconds delay{0};
  unsigned times = 1;
};

/// Called on the io thread for each frame of a session.
using frame_filter =
    std::function<traffic_verdict(traffic_direction, std::string_view text)>;

} // namespace roscell
