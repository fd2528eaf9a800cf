#include "skills/engine/file/file_reading.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace roscell::engine {

namespace {

std::chrono::system_clock::time_point to_time(const timespec& t) {
  using namespace std::chrono;
  return system_clock::time_point{duration_cast<system_clock::duration>(
      seconds{t.tv_sec} + nanoseconds{t.tv_nsec})};
}

/// Appends up to `most` bytes. Returns 0 or an errno.
int read_up_to(int fd, std::size_t most, std::string& content) {
  char buffer[65536];
  while (content.size() < most) {
    auto n =
        ::read(fd, buffer, std::min(sizeof(buffer), most - content.size()));
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return n < 0 ? errno : 0;
    content.append(buffer, static_cast<std::size_t>(n));
  }
  return 0;
}

} // namespace

file_options read_file_options(const parameters& options) {
  return {options.flag("follow", true), options.flag("loop", false),
          options.number("rate_hz", 0, 0, 1'000'000),
          options.count("max_frame_mib", 64, 1, 65536) * 1024 * 1024};
}

file_identity file_identity::of(const struct stat& info) {
  return {info.st_dev, info.st_ino, info.st_size, info.st_mtim};
}

bool file_identity::operator==(const file_identity& other) const {
  return device == other.device && inode == other.inode && size == other.size
         && modified.tv_sec == other.modified.tv_sec
         && modified.tv_nsec == other.modified.tv_nsec;
}

std::string parent_folder(const std::string& path) {
  auto slash = path.find_last_of('/');
  return slash == 0 ? "/" : path.substr(0, slash);
}

std::string base_name(const std::string& path) {
  return path.substr(path.find_last_of('/') + 1);
}

std::optional<whole_file> read_whole_file(const std::string& path,
                                          std::size_t max_bytes,
                                          const say_function& say) {
  auto fail = [&](const std::string& reason) {
    say("skipped '" + path + "': " + reason);
    return std::nullopt;
  };
  // A pipe in the folder must not block the skill.
  unique_fd fd{::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  if (!fd && (errno == ENOENT || errno == ENXIO))
    return std::nullopt;
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0)
    return fail(std::strerror(errno));
  if (!S_ISREG(info.st_mode))
    return std::nullopt;
  whole_file result;
  auto& content = result.content.payload;
  auto size = static_cast<std::size_t>(info.st_size);
  content.reserve(std::min(size, max_bytes) + 1);
  if (auto error = read_up_to(fd.get(), max_bytes + 1, content))
    return fail(std::strerror(error));
  if (content.size() > max_bytes)
    return fail("larger than " + std::to_string(max_bytes)
                + " bytes; see parameter 'max_frame_mib'");
  result.content.name = base_name(path);
  result.content.time = to_time(info.st_mtim);
  result.identity = file_identity::of(info);
  return result;
}

namespace {

constexpr std::chrono::seconds look_period{1};

constexpr const char* remedy =
    "raise fs.inotify.max_user_instances, or set the parameter 'follow' to "
    "false";

} // namespace

inotify_watch::inotify_watch(const say_function& say)
    : fd_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  if (!fd_ && errno == EMFILE)
    poll_instead(say);
  if (!fd_)
    throw start_error(std::string{"cannot follow files: "}
                      + std::strerror(errno) + "; " + remedy);
}

void inotify_watch::poll_instead(const say_function& say) {
  fd_ =
      unique_fd{::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)};
  if (!fd_)
    return;
  itimerspec period{};
  period.it_value.tv_sec = period.it_interval.tv_sec = look_period.count();
  ::timerfd_settime(fd_.get(), 0, &period, nullptr);
  looks_ = true;
  if (say)
    say(std::string{"all inotify instances of this user are in use: files are "
                    "looked at once a second instead; "}
        + remedy);
}

bool inotify_watch::may_be_unfinished(const struct stat& file) const {
  using namespace std::chrono;
  if (!looks_)
    return false;
  const auto age =
      system_clock::now().time_since_epoch()
      - (seconds{file.st_mtim.tv_sec} + nanoseconds{file.st_mtim.tv_nsec});
  // One of the future would be waited for too long.
  return age >= nanoseconds{0} && age < look_period;
}

int inotify_watch::add(const std::string& path, std::uint32_t mask) {
  if (looks_)
    return ++last_watch_;
  return ::inotify_add_watch(fd_.get(), path.c_str(), mask);
}

void inotify_watch::remove(int watch) {
  if (watch >= 0 && !looks_)
    ::inotify_rm_watch(fd_.get(), watch);
}

std::vector<inotify_watch::event> inotify_watch::read() {
  alignas(inotify_event) char buffer[4096];
  std::vector<event> result;
  if (looks_) {
    std::uint64_t times = 0;
    if (::read(fd_.get(), &times, sizeof(times)) == sizeof(times))
      result.push_back({-1, IN_Q_OVERFLOW, {}});
    return result;
  }
  auto size = ::read(fd_.get(), buffer, sizeof(buffer));
  for (ssize_t at = 0; at < size;) {
    const auto* e = reinterpret_cast<const inotify_event*>(buffer + at);
    // The kernel pads the name with zeros.
    std::string name = e->len > 0 ? std::string{e->name} : std::string{};
    result.push_back({e->wd, e->mask, std::move(name)});
    at += static_cast<ssize_t>(sizeof(inotify_event) + e->len);
  }
  return result;
}

} // namespace roscell::engine
