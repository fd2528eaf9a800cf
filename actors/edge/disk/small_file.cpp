#include "actors/edge/disk/small_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace roscell {

namespace {

/// Of a file read at once: more than most have.
constexpr size_t step_bytes = 4096;

ssize_t read_some(int fd, char* to, size_t bytes) {
  ssize_t n = 0;
  do {
    n = ::read(fd, to, bytes);
  } while (n < 0 && errno == EINTR);
  return n;
}

} // namespace

std::optional<std::string> read_small_file(const std::filesystem::path& path,
                                           size_t max_bytes) {
  // A path may name a pipe that nobody writes to.
  const unique_fd fd{
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
  if (!fd)
    return std::nullopt;
  std::string result;
  for (;;) {
    // A byte beyond what is allowed tells a file that is too long.
    const auto size = result.size();
    result.resize(size + std::min(step_bytes, max_bytes + 1 - size));
    const auto n = read_some(fd.get(), &result[size], result.size() - size);
    if (n < 0)
      return std::nullopt;
    result.resize(size + static_cast<size_t>(n));
    if (result.size() > max_bytes)
      return std::nullopt;
    if (n > 0)
      continue;
    // Whoever keeps it keeps no more than it has.
    result.shrink_to_fit();
    return result;
  }
}

bool write_whole(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return false;
    bytes.remove_prefix(static_cast<size_t>(n));
  }
  return true;
}

std::string write_lasting(const std::filesystem::path& file,
                          const std::string& text) {
  auto fresh = file;
  fresh += ".new";
  const unique_fd fd{
      ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)};
  if (fd && write_whole(fd.get(), text) && ::fsync(fd.get()) == 0
      && ::rename(fresh.c_str(), file.c_str()) == 0)
    return {};
  const int problem = errno;
  return "cannot write '" + file.string() + "': " + std::strerror(problem);
}

} // namespace roscell
