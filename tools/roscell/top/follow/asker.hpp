#pragma once

#include "tools/roscell/top/follow/mailbox.hpp"
#include "tools/roscell/top/follow/node_link.hpp"
#include "tools/roscell/top/model/cell_model.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace roscell::cli::top {

/// Asks a node, on a thread of its own. What is wanted while it waits is asked
/// together and once, four times a second at most, and more seldom where the
/// node takes long to answer.
class asker {
public:
  asker(const http_endpoint& node, mailbox& to);
  ~asker();

  asker(const asker&) = delete;
  asker& operator=(const asker&) = delete;

  void ask(const questions& what);

private:
  void run();

  /// Waits for questions until they are due; false: there are to be none.
  bool wait_for_questions(questions& due);

  void answer(const questions& due);
  void ask_for_cell();

  node_link node_;
  mailbox& to_;
  std::chrono::steady_clock::time_point earliest_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  questions wanted_;
  bool ended_ = false;
  std::thread worker_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
