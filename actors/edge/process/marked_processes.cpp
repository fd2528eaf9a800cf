#include "actors/edge/process/marked_processes.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/pidfd.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <memory>
#include <string_view>
#include <vector>

namespace roscell {

namespace {

constexpr int rounds = 20;
constexpr int round_ms = 50;

/// The kernel's own bound of all that a program is started with.
constexpr size_t max_environment_bytes = 6 * 1024 * 1024;

struct folder_closer {
  void operator()(DIR* x) const {
    ::closedir(x);
  }
};

/// The environment that a process was started with; empty for one of another
/// user.
std::string environment_of(const std::string& pid) {
  const unique_fd file{
      ::open(("/proc/" + pid + "/environ").c_str(), O_RDONLY | O_CLOEXEC)};
  std::string result;
  char buffer[16 * 1024];
  while (file && result.size() < max_environment_bytes) {
    const auto n = ::read(file.get(), buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      break;
    result.append(buffer, static_cast<size_t>(n));
  }
  return result;
}

/// Whether one of the entries, which end with a zero each, is `entry`.
bool has_entry(std::string_view environment, std::string_view entry) {
  while (!environment.empty()) {
    const auto end = std::min(environment.find('\0'), environment.size());
    if (environment.substr(0, end) == entry)
      return true;
    environment.remove_prefix(std::min(end + 1, environment.size()));
  }
  return false;
}

/// A descriptor for each process with that entry. Opened before the entry is
/// read: a number that is given away meanwhile has another environment.
std::vector<unique_fd> find_marked(const std::string& entry) {
  std::vector<unique_fd> result;
  const std::unique_ptr<DIR, folder_closer> folder{::opendir("/proc")};
  while (const auto* x = folder ? ::readdir(folder.get()) : nullptr) {
    const std::string name{static_cast<const char*>(x->d_name)};
    pid_t pid = 0;
    const auto* end = name.data() + name.size();
    if (std::from_chars(name.data(), end, pid).ptr != end || pid <= 1
        || !has_entry(environment_of(name), entry))
      continue;
    unique_fd process{::pidfd_open(pid, 0)};
    if (process && has_entry(environment_of(name), entry))
      result.push_back(std::move(process));
  }
  return result;
}

void kill_and_await(const std::vector<unique_fd>& processes) {
  for (const auto& x : processes)
    ::pidfd_send_signal(x.get(), SIGKILL, nullptr, 0);
  for (const auto& x : processes) {
    pollfd waited{x.get(), POLLIN, 0};
    ::poll(&waited, 1, round_ms);
  }
}

} // namespace

int kill_marked_processes(const std::string& name, const std::string& value) {
  int killed = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto found = find_marked(name + '=' + value);
    if (found.empty())
      break;
    if (round == 0)
      killed = static_cast<int>(found.size());
    kill_and_await(found);
  }
  return killed;
}

} // namespace roscell
