#pragma once

#include "tools/roscell/node_client.hpp"

#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace roscell::cli {

/// Tells on standard error what a node does for a task, from the node's own
/// events. Silent until `begin`, which then first tells what was missed.
class progress {
public:
  /// `node` must outlive this. Never fails: without events there is just no
  /// progress to be told.
  progress(const node_client& node, std::string task);
  ~progress();

  progress(const progress&) = delete;
  progress& operator=(const progress&) = delete;

  void begin();

private:
  void read(const node_client& node);
  void tell(const std::string& line);

  std::string task_;
  http_cancel cancel_;
  std::mutex mutex_;
  bool begun_ = false;
  std::vector<std::string> held_; ///< Lines until `begin`.
  std::thread reader_;            // Last: it uses all the others.
};

} // namespace roscell::cli
