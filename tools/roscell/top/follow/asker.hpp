#pragma once

#include "client/cell_model.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace roscell::cli::top {

/// What threads want done by the one that draws, which waits for a descriptor.
class mailbox {
public:
  using work = std::function<void()>;

  mailbox();
  ~mailbox();

  mailbox(const mailbox&) = delete;
  mailbox& operator=(const mailbox&) = delete;

  void put(work x);

  /// Does all that is there, in order. The descriptor is not readable any more
  /// then.
  void work_off();

  /// Readable while there is something.
  int fd() const {
    return fd_;
  }

private:
  int fd_;
  std::mutex mutex_;
  std::vector<work> waiting_;
};

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

/// Follows the log of one instance on a thread of its own: its last lines, then
/// each as it is written. Why it ends is a last line.
class log_follower {
public:
  /// Called by who works off the mailbox.
  using line_taker = std::function<void(const std::string& line)>;

  log_follower(const node_client& node, std::string instance, mailbox& to,
               line_taker take);
  ~log_follower();

  log_follower(const log_follower&) = delete;
  log_follower& operator=(const log_follower&) = delete;

  const std::string& instance() const {
    return instance_;
  }

private:
  void run();
  void put(const std::string& line);

  const node_client& node_;
  http_cancel cancel_;
  std::string instance_;
  mailbox& to_;
  line_taker take_;
  std::thread reader_; // Last: it uses all the others.
};

} // namespace roscell::cli::top
