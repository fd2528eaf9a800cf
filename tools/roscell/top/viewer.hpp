#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/top/follow/asker.hpp"
#include "tools/roscell/top/follow/event_follower.hpp"
#include "tools/roscell/top/follow/log_follower.hpp"
#include "tools/roscell/top/layout/frame.hpp"
#include "tools/roscell/top/terminal/screen.hpp"
#include "tools/roscell/top/terminal/signals.hpp"

#include <chrono>
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

  // What each piece of news means.
  void take(events_opened x);
  void take(events_lost x);
  void take(event x);
  void take(cell_answer x);
  void take(metrics_answer x);
  void take(skill_list x);
  void take(question_failed x);
  void take(log_line x);

  void stop();
  void follow_log();
  void ask_for_metrics();
  void draw();

  http_endpoint node_;
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
