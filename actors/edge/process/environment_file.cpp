#include "actors/edge/process/environment_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace roscell {

namespace fs = std::filesystem;

namespace {

bool has_listener(int file) {
  return ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

} // namespace

fs::path environment_file_of(const fs::path& notify_socket) {
  return notify_socket.native() + ".environment";
}

void make_environment_file(const fs::path& file) {
  ::unlink(file.c_str());
  const unique_fd made{
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)};
}

bool tell_environment(const fs::path& file,
                      const std::map<std::string, std::string>& variables) {
  const unique_fd fd{::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW)};
  if (!fd || !has_listener(fd.get()))
    return false;
  const auto text = nlohmann::json(variables).dump(
      -1, ' ', false, nlohmann::json::error_handler_t::replace);
  // The same file, on which the lock is. It is read when it is closed.
  return ::ftruncate(fd.get(), 0) == 0
         && ::pwrite(fd.get(), text.data(), text.size(), 0)
                == static_cast<ssize_t>(text.size());
}

} // namespace roscell
