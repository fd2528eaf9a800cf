#include "tools/compare_poses/file_watch.hpp"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace roscell::comparison {

namespace {

/// Throws std::runtime_error.
void watch_folder(int fd, const std::string& folder) {
  constexpr auto growing = IN_MODIFY | IN_CREATE | IN_MOVED_TO;
  if (::inotify_add_watch(fd, folder.c_str(), growing) < 0)
    throw std::runtime_error("cannot watch '" + folder
                             + "': " + std::strerror(errno));
}

} // namespace

file_watch::file_watch(const std::vector<std::string>& paths)
    : fd_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  try {
    for (const auto& path : paths)
      watch_folder(fd_, std::filesystem::absolute(path).parent_path());
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

file_watch::~file_watch() {
  ::close(fd_);
}

bool file_watch::wait_until(clock::time_point deadline) const {
  using namespace std::chrono;
  auto left = duration_cast<milliseconds>(deadline - clock::now()).count();
  // Longer than anybody waits, and short enough for poll.
  constexpr std::int64_t most_ms = 3'600'000;
  pollfd waited{fd_, POLLIN, 0};
  auto limit_ms = static_cast<int>(std::clamp<std::int64_t>(left, 0, most_ms));
  if (::poll(&waited, 1, limit_ms) < 1)
    return false;
  char events[8192];
  while (::read(fd_, events, sizeof(events)) > 0) {
    // Which file it was does not matter.
  }
  return true;
}

} // namespace roscell::comparison
