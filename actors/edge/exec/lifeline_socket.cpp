#include "actors/edge/exec/lifeline_socket.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace roscell {

edge_result<lifeline_socket> lifeline_socket::open(std::filesystem::path path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  unique_fd fd{::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)};
  const bool fits = path.native().size() < sizeof(address.sun_path);
  path.native().copy(address.sun_path, sizeof(address.sun_path) - 1);
  ::unlink(path.c_str());
  if (!fits || !fd
      || ::bind(fd.get(), reinterpret_cast<const sockaddr*>(&address),
                sizeof(address))
             != 0
      || ::listen(fd.get(), 1) != 0)
    return edge_error{error_code::engine_failed,
                      "cannot make the socket '" + path.string()
                          + "': " + std::strerror(fits ? errno : ENAMETOOLONG),
                      "check whether its file system has room"};
  return lifeline_socket{std::move(path), std::move(fd)};
}

lifeline_socket::~lifeline_socket() {
  cut();
}

void lifeline_socket::cut() {
  if (!fd_)
    return;
  ::unlink(path_.c_str());
  fd_.reset();
}

} // namespace roscell
