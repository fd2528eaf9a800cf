#include "actors/edge/process/environment_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <climits>

namespace roscell {

namespace fs = std::filesystem;

namespace {

unique_fd open_fifo(const fs::path& file, int how) {
  unique_fd result{
      ::open(file.c_str(), how | O_NONBLOCK | O_CLOEXEC | O_NOFOLLOW)};
  struct stat status {};
  if (result
      && (::fstat(result.get(), &status) != 0 || !S_ISFIFO(status.st_mode)))
    return {};
  return result;
}

} // namespace

fs::path environment_file_of(const fs::path& notify_socket) {
  return notify_socket.native() + ".environment";
}

void make_environment_file(const fs::path& file) {
  ::unlink(file.c_str());
  ::mkfifo(file.c_str(), 0600);
}

bool write_environment_update(
    const fs::path& file, const std::map<std::string, std::string>& variables) {
  // It cannot be opened where nobody reads it.
  const auto out = open_fifo(file, O_WRONLY);
  if (!out)
    return false;
  // Who is gone meanwhile must not end this process by a SIGPIPE.
  const auto reader = open_fifo(file, O_RDONLY);
  const auto text =
      nlohmann::json(variables).dump(-1, ' ', false,
                                     nlohmann::json::error_handler_t::replace)
      + "\n";
  // So much is written whole, or not at all.
  return reader && text.size() <= PIPE_BUF
         && ::write(out.get(), text.data(), text.size())
                == static_cast<ssize_t>(text.size());
}

} // namespace roscell
