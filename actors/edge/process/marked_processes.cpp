#include "actors/edge/process/process_identity.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
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

/// The environment that a process was started with; none for one of another
/// user.
std::optional<std::string> environment_of(const std::string& pid) {
  const unique_fd file{
      ::open(("/proc/" + pid + "/environ").c_str(), O_RDONLY | O_CLOEXEC)};
  if (!file)
    return std::nullopt;
  std::string result;
  char buffer[16 * 1024];
  while (result.size() < max_environment_bytes) {
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

/// Whether a process whose environment looks empty is on its way from one
/// program to the next: it has memory (field 23 of /proc/PID/stat), and the
/// kernel says of the place of its environment (from field 50 to field 51)
/// nothing yet, or that something is there.
bool changes_program(const std::string& pid) {
  std::ifstream file{"/proc/" + pid + "/stat"};
  std::string stat{std::istreambuf_iterator<char>{file}, {}};
  // The program's name, field 2, may have blanks and brackets.
  const auto name_end = stat.rfind(')');
  if (name_end == std::string::npos)
    return false;
  std::istringstream in{stat.substr(name_end + 1)};
  constexpr size_t first_field = 3;
  const std::vector<std::string> fields{std::istream_iterator<std::string>{in},
                                        {}};
  const auto field = [&](size_t number) {
    return fields.at(number - first_field);
  };
  return fields.size() > 51 - first_field && field(23) != "0"
         && (field(51) == "0" || field(51) != field(50));
}

struct search_result {
  std::map<pid_t, unique_fd> found;
  bool undecided = false; ///< Somebody has to be looked at again.
};

/// A descriptor for each process with that entry. Opened before the entry is
/// read: a number that is given away meanwhile has another environment.
search_result find_marked(const std::string& entry) {
  search_result result;
  const std::unique_ptr<DIR, folder_closer> folder{::opendir("/proc")};
  while (const auto* x = folder ? ::readdir(folder.get()) : nullptr) {
    const std::string name{static_cast<const char*>(x->d_name)};
    pid_t pid = 0;
    const auto* end = name.data() + name.size();
    if (std::from_chars(name.data(), end, pid).ptr != end || pid <= 1)
      continue;
    const auto environment = environment_of(name);
    if (environment && environment->empty())
      result.undecided = result.undecided || changes_program(name);
    if (!environment || !has_entry(*environment, entry))
      continue;
    unique_fd process{::pidfd_open(pid, 0)};
    const auto again = environment_of(name);
    if (process && again && has_entry(*again, entry))
      result.found.emplace(pid, std::move(process));
    else
      result.undecided = true;
  }
  return result;
}

bool has_ended(const unique_fd& process, int limit_ms) {
  pollfd waited{process.get(), POLLIN, 0};
  return ::poll(&waited, 1, limit_ms) != 0;
}

/// Waits for `round_ms` at most.
bool have_ended(const std::map<pid_t, unique_fd>& processes) {
  bool all = true;
  for (const auto& [pid, x] : processes)
    all = has_ended(x, all ? round_ms : 0) && all;
  return all;
}

} // namespace

int kill_marked_processes(const std::string& name, const std::string& value) {
  std::map<pid_t, unique_fd> killed;
  for (int round = 0; round < rounds; ++round) {
    auto now = find_marked(name + '=' + value);
    for (auto& [pid, x] : now.found) {
      ::pidfd_send_signal(x.get(), SIGKILL, nullptr, 0);
      killed.insert_or_assign(pid, std::move(x));
    }
    // Who ends has no environment any more, some time before it has ended.
    const bool ended = have_ended(killed);
    if (now.found.empty() && ended && !now.undecided)
      break;
    if (now.undecided)
      ::poll(nullptr, 0, 1);
  }
  return static_cast<int>(killed.size());
}

} // namespace roscell
