#pragma once

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/shell/builtins/event_filter.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace roscell::cli {

/// What a prompt tells of the node.
struct node_connection_status {
  std::string node; ///< Empty as long as it has never answered.
  std::string cell; ///< Empty: it is in none.
  bool is_reachable = false;
};

/// Follows the events of a node on a thread of its own. A node that is lost is
/// looked for again, with growing pauses.
class follower {
public:
  explicit follower(const node_client& node);
  ~follower();

  follower(const follower&) = delete;
  follower& operator=(const follower&) = delete;

  /// Waits until the node has answered or was found to be lost, but not long.
  void await_first_answer();

  node_connection_status status() const;

  /// Readable while there is something new to be shown.
  int news_fd() const {
    return news_.get();
  }

  /// The lines to be shown since the last call, without their ends.
  std::vector<std::string> take_lines();

  /// Shows such events from now on; none: no event.
  void show(std::optional<event_filter> filter);

  /// Looks for a node that is lost now, not after a pause.
  void refresh_now();

  /// The kinds of the events that have come so far.
  std::set<std::string> kinds() const;

private:
  void run();
  void follow_once();
  uint64_t begin_of_events();
  json ask_for_node();
  void on_open();
  void on_event(const event& e);
  void report_lost_contact(const std::string& why);
  void pause();
  void add_line(std::string line);

  const node_client& node_;
  unique_fd news_;
  http_cancel cancel_;
  // Of the thread alone.
  std::chrono::milliseconds pause_;
  int64_t started_unix_ms_ = 0; ///< Of the node; 0: it was never seen.
  uint64_t last_ = from_now_on;
  // Of all threads.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool answered_ = false; ///< Or found to be lost.
  bool hurries_ = false;
  bool ends_ = false;
  node_connection_status status_;
  std::optional<event_filter> filter_;
  std::set<std::string> kinds_;
  std::vector<std::string> lines_;
  size_t left_out_ = 0;
  std::thread thread_; // Last: it uses all the others.
};

} // namespace roscell::cli
