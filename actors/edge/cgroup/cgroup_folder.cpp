#include "actors/edge/cgroup/cgroup_folder.hpp"

#include "actors/edge/cgroup/cgroup_tables.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <vector>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// 10,000 numbers and more.
constexpr size_t most_list_bytes = 1024 * 1024;
constexpr size_t most_event_bytes = 4096;

std::vector<pid_t> members_of(const fs::path& folder) {
  const auto text =
      read_small_file(folder / "cgroup.procs", most_list_bytes).value_or("");
  std::vector<pid_t> result;
  std::string_view rest{text};
  while (!rest.empty()) {
    const auto end = std::min(rest.find('\n'), rest.size());
    // 0 is one of another pid namespace.
    if (const auto pid = number_alone(rest.substr(0, end)); pid > 0)
      result.push_back(static_cast<pid_t>(pid));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return result;
}

/// Sends it to all who are there. Whoever is frozen starts nothing meanwhile.
bool kill_members(const fs::path& folder) {
  const auto state = folder / "freezer.state";
  const auto freezes = put_word(state, "FROZEN");
  const auto members = members_of(folder);
  for (const auto pid : members)
    ::kill(pid, SIGKILL);
  if (freezes)
    put_word(state, "THAWED");
  return !members.empty();
}

} // namespace

bool put_word(const fs::path& file, const std::string& word) {
  const unique_fd to{::open(file.c_str(), O_WRONLY | O_CLOEXEC)};
  return to && write_whole(to.get(), word);
}

bool is_unified_cgroup(const fs::path& folder) {
  return ::access((folder / "cgroup.controllers").c_str(), F_OK) == 0;
}

bool kill_members_of(const fs::path& folder) {
  if (!is_unified_cgroup(folder))
    return kill_members(folder);
  const auto events =
      read_small_file(folder / "cgroup.events", most_event_bytes).value_or("");
  if (value_of(events, "populated") != 1)
    return false;
  if (!put_word(folder / "cgroup.kill", "1"))
    kill_members(folder);
  return true;
}

namespace {

/// Cgroups that the instance has made in its own, as far as it may.
void remove_below(const fs::path& folder, int level = 0) {
  constexpr int most_levels = 16;
  std::error_code error;
  std::vector<fs::path> inner;
  if (level < most_levels)
    for (fs::directory_iterator i{folder, error}, end; !error && i != end;
         i.increment(error))
      if (i->is_directory(error))
        inner.push_back(i->path());
  for (const auto& x : inner) {
    kill_members_of(x);
    remove_below(x, level + 1);
    ::rmdir(x.c_str());
  }
}

} // namespace

bool remove_cgroup(const fs::path& folder) {
  if (::rmdir(folder.c_str()) == 0 || errno == ENOENT)
    return true;
  remove_below(folder);
  return ::rmdir(folder.c_str()) == 0 || errno == ENOENT;
}

} // namespace roscell
