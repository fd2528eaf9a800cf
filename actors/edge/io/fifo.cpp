#include "actors/edge/io/fifo.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

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

void make_fifo(const fs::path& file) {
  ::unlink(file.c_str());
  ::mkfifo(file.c_str(), 0600);
}

fifo_writer open_fifo_to_write(const fs::path& file) {
  fifo_writer result;
  // It cannot be opened where nobody reads it.
  result.out = open_fifo(file, O_WRONLY);
  result.is_there = result.out || errno == ENXIO;
  if (result.out)
    result.reader = open_fifo(file, O_RDONLY);
  return result;
}

} // namespace roscell
