#include "actors/edge/disk/own_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace roscell {

bool make_own_folder(const std::filesystem::path& path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    return false;
  struct stat info {};
  if (::lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)
      && info.st_uid == ::geteuid() && (info.st_mode & 022) == 0)
    return true;
  errno = EPERM;
  return false;
}

} // namespace roscell
