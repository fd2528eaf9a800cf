#include "actors/edge/disk/data_folder.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/small_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

edge_error no_access(const fs::path& path, const std::string& why) {
  return {error_code::internal, "cannot use '" + path.string() + "': " + why,
          "give this user write access to it, or choose another --data-dir"};
}

edge_error held(const fs::path& folder) {
  const auto pid = read_small_file(folder / "lock", 32);
  const auto end = pid ? pid->find_first_not_of("0123456789") : 0;
  const auto holder = pid ? pid->substr(0, end) : std::string{};
  return {error_code::conflict,
          "the data directory '" + folder.string()
              + "' is in use by another node"
              + (holder.empty() ? "" : " (process " + holder + ")"),
          "stop that node, or choose another --data-dir"};
}

/// Whoever may put files into it has a node do what he likes.
std::optional<edge_error> refusal_of_folder(const fs::path& folder) {
  auto fault = who_may_change(folder);
  if (fault.empty())
    fault = who_may_replace(folder);
  if (fault.empty())
    return std::nullopt;
  return edge_error{error_code::unauthorized,
                    "the data directory '" + folder.string()
                        + "' is not taken: " + fault,
                    "choose a --data-dir that is of " + user_text(::geteuid())
                        + " alone; chmod go-w takes the right to write from "
                          "others"};
}

} // namespace

directory_lock::directory_lock(unique_fd fd) : fd_(std::move(fd)) {
  // nop
}

edge_result<directory_lock> directory_lock::take(const fs::path& folder) {
  std::error_code error;
  if (folder.has_parent_path())
    fs::create_directories(folder.parent_path(), error);
  if (error)
    return no_access(folder.parent_path(), error.message());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST)
    return no_access(folder, std::strerror(errno));
  if (auto why = refusal_of_folder(folder))
    return *why;
  const auto path = folder / "lock";
  unique_fd fd{::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)};
  if (!fd)
    return no_access(path, std::strerror(errno));
  if (::flock(fd.get(), LOCK_EX | LOCK_NB) != 0)
    return errno == EWOULDBLOCK ? held(folder)
                                : no_access(path, std::strerror(errno));
  const auto pid = std::to_string(::getpid()) + '\n';
  // Only for the error message of others.
  if (::ftruncate(fd.get(), 0) == 0) [[maybe_unused]]
    const auto n = ::write(fd.get(), pid.data(), pid.size());
  return directory_lock{std::move(fd)};
}

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
