#include "actors/edge/disk/small_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>

#include <cerrno>

namespace roscell {

std::optional<std::string> read_small_file(const std::filesystem::path& path,
                                           size_t max_bytes) {
  // A path may name a pipe that nobody writes to.
  const unique_fd fd{
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
  if (!fd)
    return std::nullopt;
  std::string result(max_bytes + 1, '\0');
  size_t size = 0;
  while (size < result.size()) {
    const auto n = ::read(fd.get(), &result[size], result.size() - size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      return std::nullopt;
    if (n == 0)
      break;
    size += static_cast<size_t>(n);
  }
  if (size > max_bytes)
    return std::nullopt;
  result.resize(size);
  return result;
}

} // namespace roscell
