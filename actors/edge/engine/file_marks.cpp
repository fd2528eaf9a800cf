#include "actors/edge/engine/file_marks.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace roscell {

namespace {

std::string text_of(const timespec& when) {
  return std::to_string(when.tv_sec) + '.' + std::to_string(when.tv_nsec);
}

} // namespace

std::string mark_of(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0)
    return {};
  return std::to_string(info.st_dev) + ' ' + std::to_string(info.st_ino) + ' '
         + std::to_string(info.st_size) + ' ' + text_of(info.st_mtim) + ' '
         + text_of(info.st_ctim);
}

bool are_unchanged(const file_marks& marks) {
  return std::all_of(marks.begin(), marks.end(), [](const auto& x) {
    return !x.second.empty() && mark_of(x.first) == x.second;
  });
}

} // namespace roscell
