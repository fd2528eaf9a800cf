#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/stop_event.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace roscell::engine {

/// Blocks SIGTERM, SIGINT and SIGUSR1 for good in the calling thread and in
/// those it starts later, so that a signal_watch can receive them.
void block_signals();

/// Waits, on a thread of its own, for what a skill is told by signals. SIGTERM
/// and SIGINT: it is to end; `on_stop` is called once, and nothing after it.
/// SIGUSR1: somebody waits for it to be stop-safe; `on_safety_wanted` is called
/// each time. Signals since block_signals() count. Once the destructor has
/// returned there are no more calls.
class signal_watch {
public:
  signal_watch(std::function<void()> on_stop,
               std::function<void()> on_safety_wanted);

  ~signal_watch();

private:
  void run();

  const std::function<void()> on_stop_;
  const std::function<void()> on_safety_wanted_;
  unique_fd signals_;
  stop_event stop_;
  std::thread thread_;
};

/// A FIFO that the node has made beside NOTIFY_SOCKET, and who takes the lines
/// that it writes there.
struct heard_lines {
  std::string path;
  std::function<void(const std::string& line)> take;
};

/// Hears, on a thread of its own, what the node writes into FIFOs. By their
/// having a reader the node knows that somebody listens; it cannot tell
/// anything where there is none. Without a FIFO there is no thread.
class fifo_watch {
public:
  explicit fifo_watch(std::vector<heard_lines> heard);

  /// There are no calls after it.
  ~fifo_watch();

private:
  struct source {
    heard_lines target;
    unique_fd fifo;
    std::string begun; ///< Of a line that has not ended.
  };

  void run();
  static void take(source& from);

  std::vector<source> sources_;
  stop_event stop_;
  std::thread thread_;
};

// What is written there. Lines that are none of these say nothing.

/// This host has got another address, and the cell is to be found elsewhere: a
/// JSON object of variables with their new values, in `.environment`.
changed_variables read_changed_variables(const std::string& line);

/// Other parameters, in `.parameters`.
struct ordered_parameters {
  std::int64_t number = 0; ///< That the answer names; 0: the line is none.
  std::string values;      ///< JSON object of all of them.
};

/// Reads {"number":7,"parameters":{...}}.
ordered_parameters read_parameter_line(const std::string& line);

/// What has become of a request for other parameters, in `.parameters`,
/// too.
struct request_answer {
  std::int64_t number = 0; ///< Of the request; 0: the line is none.
  std::string problem;     ///< A sentence; empty: it is done.
};

/// Reads {"request":7,"problem":""}.
request_answer read_answer_line(const std::string& line);

} // namespace roscell::engine
