#include "actors/edge/disk/folder_watch.hpp"

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// What comes into a folder.
constexpr uint32_t arrivals =
    IN_CREATE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF;

/// All that may make another build of a skill: a right to execute is part of
/// it. Only reading is not.
constexpr uint32_t changes = arrivals | IN_DELETE | IN_MOVED_FROM | IN_MODIFY
                             | IN_CLOSE_WRITE | IN_ATTRIB;

/// Takes what the kernel has to tell. False where it only says that a folder is
/// not watched any more, which whoever has ended that knows.
bool take_news(int fd) {
  alignas(inotify_event) std::array<char, 4096> buffer;
  bool result = false;
  for (;;) {
    const auto n = ::read(fd, buffer.data(), buffer.size());
    if (n <= 0)
      return result;
    for (size_t at = 0; at < static_cast<size_t>(n);) {
      inotify_event event{};
      std::memcpy(&event, buffer.data() + at, sizeof event);
      result = result || (event.mask & ~uint32_t{IN_IGNORED | IN_ISDIR}) != 0;
      at += sizeof event + event.len;
    }
  }
}

/// The folder itself, or the nearest one above it.
fs::path nearest_folder(fs::path path) {
  std::error_code ignored;
  while (!fs::is_directory(path, ignored) && path.has_relative_path())
    path = path.parent_path();
  return path;
}

} // namespace

/// One look at the folders that are to be watched.
struct folder_watch::pass {
  const folder_watch& owner;
  std::set<int> found = {};
  std::string problem = {};

  /// False once no more can be watched.
  bool add(const fs::path& folder, uint32_t mask) {
    if (!problem.empty())
      return false;
    if (found.size() >= owner.most_) {
      problem = "more than " + std::to_string(owner.most_) + " folders";
      return false;
    }
    // A folder may be watched for more than one reason.
    const int number = ::inotify_add_watch(
        owner.inotify_->get(), folder.c_str(), mask | IN_ONLYDIR | IN_MASK_ADD);
    if (number >= 0)
      found.insert(number);
    else if (errno == ENOSPC || errno == ENOMEM || errno == EBADF)
      problem = errno == ENOSPC
                    ? "no more watches (fs.inotify.max_user_watches)"
                    : std::strerror(errno);
    return problem.empty();
  }

  /// A folder is watched before it is listed, so that one which comes in
  /// between is found, or told of.
  void add_whole(const fs::path& folder) {
    std::error_code error;
    constexpr auto skip = fs::directory_options::skip_permission_denied;
    for (fs::recursive_directory_iterator i{folder, skip, error}, end;
         !error && i != end; i.increment(error)) {
      std::error_code gone;
      if (i->is_directory(gone) && !i->is_symlink(gone)
          && !add(i->path(), changes))
        return;
    }
  }
};

folder_watch::folder_watch(const std::shared_ptr<io_core>& core,
                           std::function<void()> on_change, size_t most)
    : inotify_{share(unique_fd{::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)})},
      most_{most} {
  if (*inotify_)
    reading_ = {core, inotify_,
                [fd = inotify_, call = std::move(on_change)] {
                  if (take_news(fd->get()))
                    call();
                  return true;
                },
                limits::folder::change_pause};
}

std::string folder_watch::follow(const std::vector<watched_folder>& folders) {
  if (!*inotify_)
    return "no more of the kernel's watchers (fs.inotify.max_user_instances)";
  pass now{*this};
  for (const auto& x : folders) {
    const auto there = nearest_folder(x.path);
    if (now.add(there, there == x.path ? changes : arrivals) && x.whole
        && there == x.path)
      now.add_whole(there);
  }
  for (const auto number : watched_)
    if (now.found.count(number) == 0)
      ::inotify_rm_watch(inotify_->get(), number);
  watched_ = std::move(now.found);
  return now.problem;
}

} // namespace roscell
