#include "actors/edge/process/log_watch.hpp"

#include "actors/edge/process/limits.hpp"

#include <sys/inotify.h>

#include <array>
#include <chrono>
#include <utility>

namespace roscell {

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
