#include "actors/edge/disk/lasting_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace roscell {

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
