#include "skills/engine/life/notify_socket.hpp"

#include "roscell/skill/errors.hpp"

#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace roscell::engine {

notify_socket::notify_socket(const std::string& name) {
  if (name.empty())
    return;
  auto known = name.front() == '/' || name.front() == '@';
  if (!known || name.size() < 2 || name.size() >= sizeof(address_.sun_path))
    throw start_error("NOTIFY_SOCKET must be an absolute path or '@' and a "
                      "name, of less than "
                      + std::to_string(sizeof(address_.sun_path))
                      + " bytes, but is '" + name + "'");
  address_.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address_.sun_path);
  auto size = offsetof(sockaddr_un, sun_path) + name.size();
  if (name.front() == '@')
    address_.sun_path[0] = '\0';
  else
    ++size; // A path includes its terminating zero.
  address_size_ = static_cast<unsigned>(size);
  fd_ = unique_fd{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!fd_)
    throw start_error(std::string{"cannot make a socket for NOTIFY_SOCKET: "}
                      + std::strerror(errno));
  timeval limit{1, 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
}

int notify_socket::send(const std::string& state) const {
  if (!fd_)
    return 0;
  // The address is looked up at each call: a restarted node has bound a new
  // socket to the same name.
  auto n =
      ::sendto(fd_.get(), state.data(), state.size(), MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&address_), address_size_);
  return n < 0 ? errno : 0;
}

} // namespace roscell::engine
