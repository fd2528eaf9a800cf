#pragma once

#include "client/known_cell.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/top/follow/asker.hpp"
#include "tools/roscell/top/layout/frame.hpp"
#include "tools/roscell/top/terminal/screen.hpp"
#include "tools/roscell/top/terminal/signals.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace roscell::cli::top {

/// Shows a cell until somebody has seen enough: waits for keys, for signals and
/// for what the node tells, all in one place, and draws what has changed.
class viewer {
public:
  viewer(const node_client& node, controls begin);

  void run();

private:
  using clock = std::chrono::steady_clock;

  /// Until there is something, or something is due.
  void wait();

  void read_signals();
  void read_keys();
  void read_news();
  event_follower::hooks event_hooks();
  void add_log_line(const std::string& text);

  void stop();
  void follow_log();
  void ask_for_metrics();
  void draw();

  const node_client& node_;
  terminal_signals signals_; // Before any thread.
  mailbox mail_;
  cell_model model_;
  controls controls_;
  std::vector<std::string> log_;
  frame shown_;
  clock::time_point drawn_;        ///< When it was drawn last.
  clock::time_point next_refresh_; ///< When metrics are due.
  bool changed_ = true;            ///< What is drawn is not what is known.
  bool left_ = false;
  screen screen_;
  event_follower events_;
  asker asker_;
  std::unique_ptr<log_follower> log_reader_;
};

} // namespace roscell::cli::top
