#include "skills/engine/file/inotify_watch.hpp"

#include "roscell/skill/errors.hpp"

#include <sys/inotify.h>

#include <cerrno>
#include <cstring>

namespace roscell::engine {

inotify_watch::inotify_watch()
    : fd_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  if (!fd_)
    throw start_error(std::string{"cannot follow files: "}
                      + std::strerror(errno)
                      + "; raise fs.inotify.max_user_instances, or set the "
                        "parameter 'follow' to false");
}

int inotify_watch::add(const std::string& path, std::uint32_t mask) {
  return ::inotify_add_watch(fd_.get(), path.c_str(), mask);
}

void inotify_watch::remove(int watch) {
  if (watch >= 0)
    ::inotify_rm_watch(fd_.get(), watch);
}

std::vector<inotify_watch::event> inotify_watch::read() {
  alignas(inotify_event) char buffer[4096];
  std::vector<event> result;
  auto size = ::read(fd_.get(), buffer, sizeof(buffer));
  for (ssize_t at = 0; at < size;) {
    const auto* e = reinterpret_cast<const inotify_event*>(buffer + at);
    // The kernel pads the name with zeros.
    std::string name = e->len > 0 ? std::string{e->name} : std::string{};
    result.push_back({e->wd, e->mask, std::move(name)});
    at += static_cast<ssize_t>(sizeof(inotify_event) + e->len);
  }
  return result;
}

} // namespace roscell::engine
