#pragma once

#include "actors/edge/io/unique_fd.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace roscell {

class io_core;

/// Gets one sentence about something that went wrong and was survived.
using edge_log = std::function<void(const std::string&)>;

/// The one thread that runs every socket of a node: one event loop, which
/// sleeps in epoll while nothing happens. A handler that throws is reported
/// to the log and the loop goes on. All signals are blocked in the thread.
class io_thread {
public:
  /// Starts the thread. `log` is called on it.
  explicit io_thread(edge_log log = {});

  /// Calls `stop`.
  ~io_thread();

  io_thread(const io_thread&) = delete;
  io_thread& operator=(const io_thread&) = delete;

  /// Runs `task` on the thread, after all tasks posted before. From any
  /// thread. Does nothing once `stop` was called.
  void post(std::function<void()> task);

  /// Closes every server, session and socket that still lives here, which
  /// calls their closing callbacks, and joins the thread. Objects made on
  /// this thread stay valid, their methods do nothing any more. When called
  /// on the thread itself it returns before the thread has ended.
  void stop();

  /// What the other classes of this folder are built on.
  const std::shared_ptr<io_core>& core() const {
    return core_;
  }

private:
  std::shared_ptr<io_core> core_;
  std::thread thread_;
};

class watched_fd;

/// Calls back on the io thread whenever a descriptor can be read, until this
/// object ends. Costs nothing while there is nothing to read.
class fd_watch {
public:
  /// Returns whether to go on.
  using callback = std::function<bool()>;

  /// Watches nothing.
  fd_watch() = default;

  /// After each call nothing is looked at for a time of `pause`: whoever writes
  /// without end gets `1 / pause` calls a second and no more.
  fd_watch(const std::shared_ptr<io_core>& core, shared_fd fd,
           callback on_readable,
           std::chrono::milliseconds pause = std::chrono::milliseconds{0});

  fd_watch(fd_watch&&) noexcept = default;
  fd_watch& operator=(fd_watch&& other) noexcept;

  /// A call that runs on the io thread at this moment is not waited for.
  ~fd_watch();

private:
  void stop() noexcept;

  std::shared_ptr<io_core> core_;
  std::shared_ptr<watched_fd> watched_;
};

} // namespace roscell
