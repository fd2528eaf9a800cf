#include "actors/edge/history/kept_files.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>

#include <algorithm>

namespace roscell {

namespace fs = std::filesystem;

bool look_at(const fs::path& path, struct stat& info) {
  return ::lstat(path.c_str(), &info) == 0;
}

bool is_folder(const fs::path& path) {
  struct stat info {};
  return look_at(path, info) && S_ISDIR(info.st_mode);
}

bool is_file(const fs::path& path) {
  struct stat info {};
  return look_at(path, info) && S_ISREG(info.st_mode);
}

namespace {

/// What one file or folder, without what is in it, takes on the disk.
uint64_t bytes_of(const fs::path& path) {
  constexpr uint64_t block = 512;
  struct stat info {};
  if (!look_at(path, info))
    return 0;
  return std::max(static_cast<uint64_t>(info.st_blocks) * block,
                  static_cast<uint64_t>(info.st_size));
}

} // namespace

uint64_t bytes_below(const fs::path& path) {
  auto result = bytes_of(path);
  if (is_folder(path))
    for_each_in(path, [&](const fs::path& x) { result += bytes_of(x); });
  return result;
}

bool write_file(const fs::path& path, std::string_view bytes) {
  const unique_fd fd{
      ::open(path.c_str(),
             O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600)};
  return fd && write_whole(fd.get(), bytes);
}

} // namespace roscell
