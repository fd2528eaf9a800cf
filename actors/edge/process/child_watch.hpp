#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/process/notification.hpp"

#include <filesystem>
#include <functional>
#include <memory>

namespace roscell {

/// Hears what a program says on its NOTIFY_SOCKET, as calls on the io thread,
/// 50 a second at most.
fd_watch
watch_notifications(const std::shared_ptr<io_core>& core,
                    const shared_fd& notify_socket,
                    std::function<void(const notification&)> on_notification);

/// Reads what waits at a NOTIFY_SOCKET and calls, also where nothing does, on
/// the io thread: after every call that a watch has made before.
void hear_notifications(
    const std::shared_ptr<io_core>& core, const shared_fd& notify_socket,
    std::function<void(const notification&)> on_notification);

/// Sees the end of a program at once, and hears what it says on its
/// NOTIFY_SOCKET. Both come as calls on the io thread, the end last.
class child_watch {
public:
  struct callbacks {
    std::function<void(const notification&)> on_notification;
    std::function<void()> on_end;
  };

  /// Watches nothing.
  child_watch() = default;

  child_watch(const std::shared_ptr<io_core>& core, shared_fd pidfd,
              shared_fd notify_socket, callbacks calls);

private:
  fd_watch end_;
  fd_watch notifications_;
};

/// Calls back on the io thread when a file in a folder is made, written to or
/// renamed. Calls nothing if the folder cannot be watched; then followers of a
/// log get their answers when their time is over.
fd_watch watch_folder(const std::shared_ptr<io_core>& core,
                      const std::filesystem::path& folder,
                      std::function<void()> on_change);

} // namespace roscell
