#include "actors/edge/process/notify_socket.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/fifo.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <nlohmann/json.hpp>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <string>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Linux queues net.unix.max_dgram_qlen datagrams, by default 10.
constexpr int most_datagrams = 64;

/// Marks the hash as this use's own.
constexpr std::string_view hash_key = "roscell notify socket";

edge_error failed(const std::string& what, const fs::path& path) {
  return {error_code::engine_failed,
          "cannot " + what + " '" + path.string()
              + "': " + std::strerror(errno),
          "check who owns the folder and whether its file system has room"};
}

} // namespace

fs::path notify_path(const fs::path& instance_dir) {
  auto result = instance_dir / "notify";
  if (result.native().size() < sizeof(sockaddr_un::sun_path))
    return result;
  const auto base = ::geteuid() == 0
                        ? std::string{"/run/roscell-notify"}
                        : "/tmp/roscell-notify-" + std::to_string(::geteuid());
  const auto name = to_hex(hmac_sha256(hash_key, instance_dir.native()));
  return fs::path{base} / name.substr(0, 32);
}

edge_result<unique_fd> open_notify_socket(const fs::path& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.native().size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return failed("make the socket", path);
  }
  path.native().copy(address.sun_path, sizeof(address.sun_path) - 1);
  const auto folder = path.parent_path();
  if (!make_own_folder(folder))
    return failed("keep for itself the folder", folder);
  unique_fd result{
      ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (!result)
    return failed("make a socket for", path);
  ::unlink(path.c_str());
  if (::bind(result.get(), reinterpret_cast<const sockaddr*>(&address),
             sizeof(address))
      != 0)
    return failed("make the socket", path);
  return result;
}

notification receive_notifications(int socket) {
  notification result;
  std::array<char, max_notification_bytes> buffer;
  for (int i = 0; i < most_datagrams; ++i) {
    const auto n =
        ::recv(socket, buffer.data(), buffer.size(), MSG_DONTWAIT | MSG_TRUNC);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      break;
    const auto size = static_cast<size_t>(n);
    // With MSG_TRUNC the size is that of the datagram before it was cut.
    if (size <= buffer.size())
      merge(result, parse_notification({buffer.data(), size}));
  }
  return result;
}

fs::path environment_file_of(const fs::path& notify_socket) {
  return notify_socket.native() + ".environment";
}

void make_environment_file(const fs::path& file) {
  make_fifo(file);
}

bool write_environment_update(
    const fs::path& file, const std::map<std::string, std::string>& variables) {
  const auto fifo = open_fifo_to_write(file);
  if (!fifo)
    return false;
  const auto text =
      nlohmann::json(variables).dump(-1, ' ', false,
                                     nlohmann::json::error_handler_t::replace)
      + "\n";
  // So much is written whole, or not at all.
  return text.size() <= PIPE_BUF
         && ::write(fifo.out.get(), text.data(), text.size())
                == static_cast<ssize_t>(text.size());
}

} // namespace roscell
