#pragma once

#include "actors/edge/io/unique_fd.hpp"
#include "messages/event.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell::cli {

/// Which events somebody wants to see. Nothing named: all of them.
struct event_filter {
  /// Events, or with a "*" at the end what they begin with.
  std::vector<std::string> kinds;
  /// Nodes, tasks, steps or instances that an event is about.
  std::vector<std::string> subjects;

  bool takes(const event& e) const;

  /// "node_* of arm-1"
  std::string text() const;
};

/// What a prompt tells of the node.
struct node_connection_status {
  std::string node; ///< Empty as long as it has never answered.
  std::string cell; ///< Empty: it is in none.
  bool is_reachable = false;
};

/// What a shell shows of the events of a node, which it follows. A node that is
/// lost is looked for again.
class follower {
public:
  explicit follower(const node_client& node);

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
  void ask_for_node();
  void on_event(const event& e);
  bool report_lost_contact(const std::exception_ptr& why);
  void add_line(std::string line);

  const node_client& node_;
  unique_fd news_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  bool answered_ = false; ///< Or found to be lost.
  node_connection_status status_;
  std::optional<event_filter> filter_;
  std::set<std::string> kinds_;
  std::vector<std::string> lines_;
  size_t left_out_ = 0;
  event_follower events_; // Last: it uses all the others.
};

} // namespace roscell::cli
