#include "tools/roscell/daemon/readiness.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace roscell::cli {

readiness::readiness(int fd) : fd_{fd} {
  constexpr auto variable = "NOTIFY_SOCKET";
  if (const auto* path = std::getenv(variable)) {
    socket_ = path;
    unsetenv(variable);
  }
}

void readiness::waiting(const std::string& why) {
  waited_ = true;
  notify("READY=1\nSTATUS=" + why);
}

void readiness::ready() {
  notify(std::exchange(waited_, false) ? "READY=1\nSTATUS=" : "READY=1");
  if (fd_ < 0)
    return;
  constexpr char line[] = "READY=1\n";
  // A reader that has gone does not want to know.
  [[maybe_unused]] const auto written = ::write(fd_, line, sizeof line - 1);
  ::close(std::exchange(fd_, -1));
}

void readiness::stopping() {
  notify("STOPPING=1");
}

void readiness::notify(const std::string& state) const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof address.sun_path)
    return;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  auto size = offsetof(sockaddr_un, sun_path) + socket_.size();
  if (socket_.front() == '@')
    address.sun_path[0] = '\0'; // The abstract namespace.
  else
    ++size;
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0)
    return;
  sendto(fd, state.data(), state.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address),
         static_cast<socklen_t>(size));
  close(fd);
}

} // namespace roscell::cli
