#include "skills/engine/file/inotify_watch.hpp"

#include "roscell/skill/errors.hpp"

#include <sys/inotify.h>
#include <sys/timerfd.h>

#include <cerrno>
#include <chrono>
#include <cstring>

namespace roscell::engine {

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
