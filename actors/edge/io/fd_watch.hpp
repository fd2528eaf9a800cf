#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace roscell {

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
