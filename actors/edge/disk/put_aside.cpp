#include "actors/edge/disk/put_aside.hpp"

#include <system_error>

namespace roscell {

namespace fs = std::filesystem;

namespace {

fs::path free_name(const fs::path& file) {
  for (int i = 1;; ++i) {
    fs::path result = file.string() + ".aside-" + std::to_string(i);
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(result, ignored)))
      return result;
  }
}

} // namespace

edge_result<fs::path> put_aside(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error)))
    return fs::path{};
  const auto to = free_name(file);
  for (const auto* end : {"-wal", "-shm", "-journal", ""}) {
    const fs::path from = file.string() + end;
    if (!fs::exists(fs::symlink_status(from, error)))
      continue;
    fs::rename(from, to.string() + end, error);
    if (error)
      return edge_error{error_code::internal,
                        "cannot put '" + from.string()
                            + "' aside: " + error.message(),
                        "give this user write access to its folder"};
  }
  return to;
}

} // namespace roscell
