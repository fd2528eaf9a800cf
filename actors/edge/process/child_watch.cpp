#include "actors/edge/process/child_watch.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/limits.hpp"
#include "actors/edge/process/notify_socket.hpp"

#include <sys/inotify.h>

#include <array>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

using listener = std::function<void(const notification&)>;

void hear(int socket, const listener& on_notification) {
  const auto notified = receive_notifications(socket);
  if (notified.ready || notified.alive || notified.stopping
      || !notified.status.empty() || notified.parameters_taken > 0
      || notified.parameters_refused > 0 || notified.parameters_wanted > 0)
    on_notification(notified);
}

} // namespace

fd_watch watch_notifications(const std::shared_ptr<io_core>& core,
                             const shared_fd& notify_socket,
                             listener on_notification) {
  return {core, notify_socket,
          [notify_socket, call = std::move(on_notification)] {
            hear(notify_socket->get(), call);
            return true;
          },
          limits::instance::status_pause};
}

void hear_notifications(const std::shared_ptr<io_core>& core,
                        const shared_fd& notify_socket,
                        listener on_notification) {
  core->post([notify_socket, call = std::move(on_notification)] {
    call(receive_notifications(notify_socket->get()));
  });
}

child_watch::child_watch(const std::shared_ptr<io_core>& core, shared_fd pidfd,
                         shared_fd notify_socket, callbacks calls) {
  notifications_ =
      watch_notifications(core, notify_socket, calls.on_notification);
  const auto shared = std::make_shared<const callbacks>(std::move(calls));
  end_ = fd_watch{core, std::move(pidfd), [notify_socket, shared] {
                    // What the program said last must not come after its end.
                    hear(notify_socket->get(), shared->on_notification);
                    shared->on_end();
                    return false;
                  }};
}

namespace {

void drain(int fd) {
  std::array<char, 4096> buffer;
  while (::read(fd, buffer.data(), buffer.size()) > 0) {
    // Only that something happened matters.
  }
}

} // namespace

fd_watch watch_folder(const std::shared_ptr<io_core>& core,
                      const std::filesystem::path& folder,
                      std::function<void()> on_change) {
  auto fd = share(unique_fd{::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)});
  if (!*fd
      || ::inotify_add_watch(fd->get(), folder.c_str(),
                             IN_CREATE | IN_MODIFY | IN_MOVED_TO | IN_ONLYDIR)
             < 0)
    return {};
  return {core, fd,
          [fd, call = std::move(on_change)] {
            drain(fd->get());
            call();
            return true;
          },
          limits::log::change_pause};
}

} // namespace roscell
