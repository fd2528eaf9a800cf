#include "actors/edge/disk/lasting_file.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace roscell {

namespace {

bool write_whole(int fd, const std::string& text) {
  const auto size = static_cast<ssize_t>(text.size());
  return ::write(fd, text.data(), text.size()) == size && ::fsync(fd) == 0;
}

} // namespace

std::string write_lasting(const std::filesystem::path& file,
                          const std::string& text) {
  auto fresh = file;
  fresh += ".new";
  const unique_fd fd{
      ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600)};
  if (fd && write_whole(fd.get(), text)
      && ::rename(fresh.c_str(), file.c_str()) == 0)
    return {};
  const int problem = errno;
  return "cannot write '" + file.string() + "': " + std::strerror(problem);
}

} // namespace roscell
