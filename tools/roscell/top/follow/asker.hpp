#pragma once

#include "client/cell_model.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/top/follow/mailbox.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace roscell::cli::top {

/// Asks a node, on a thread of its own, and has the answers put into a model.
/// What is wanted while it waits is asked together and once, four times a
/// second at most, and more seldom where the node takes long to answer.
class asker {
public:
  asker(const node_client& node, cell_model& model, mailbox& to);
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
  json get(const std::string& path) const;

  const node_client& node_;
  http_cancel cancel_;
  cell_model& model_; ///< Changed by what is put into the mailbox only.
  mailbox& to_;
  std::chrono::steady_clock::time_point earliest_;
  std::mutex mutex_;
  std::condition_variable wakes_;
  questions wanted_;
  bool ended_ = false;
  std::thread worker_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
