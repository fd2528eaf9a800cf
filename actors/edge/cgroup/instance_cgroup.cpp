#include "actors/edge/cgroup/instance_cgroup.hpp"

#include "actors/edge/cgroup/cgroup_tables.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <system_error>
#include <vector>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr long long mib = 1024 * 1024;

/// As for containers: less is refused there, and no program starts in it.
constexpr long long least_memory_bytes = 6 * mib;

/// Processes and threads of one instance, as for containers.
constexpr const char* most_tasks = "4096";

/// Where the folders of an instance are noted, as what a link leads to: it
/// takes no block of the disk.
constexpr const char* record_name = "cgroup";
constexpr char separator = ':';

/// The end of those who were killed is waited for in rounds, one second in all.
constexpr int kill_rounds = 50;
constexpr int kill_round_ms = 20;

void bound_memory(const fs::path& folder, double memory_mib) {
  const auto bytes = std::to_string(std::max(
      least_memory_bytes, static_cast<long long>(std::ceil(memory_mib)) * mib));
  // No swap beside it. Where the kernel does not count swap there is no file.
  if (is_unified_cgroup(folder)) {
    put_word(folder / "memory.max", bytes);
    put_word(folder / "memory.swap.max", "0");
  } else {
    put_word(folder / "memory.limit_in_bytes", bytes);
    put_word(folder / "memory.memsw.limit_in_bytes", bytes);
  }
}

void bound(const fs::path& folder, const cgroup_parent& parent,
           const instance_bounds& bounds) {
  const auto has = [&](const char* x) {
    return parent.controllers.count(x) != 0;
  };
  if (has("memory") && bounds.memory_mib > 0)
    bound_memory(folder, bounds.memory_mib);
  if (has("cpu") && bounds.cpu > 0) {
    put_word(folder / "cpu.weight", std::to_string(cpu_weight_of(bounds.cpu)));
    put_word(folder / "cpu.shares", std::to_string(cpu_shares_of(bounds.cpu)));
  }
  if (has("pids"))
    put_word(folder / "pids.max", most_tasks);
}

/// An empty folder of that name; one that is in use stays as it is.
bool make_anew(const cgroup_parent& parent, const fs::path& folder) {
  std::error_code error;
  ::rmdir(folder.c_str());
  if (::mkdir(folder.c_str(), 0755) == 0)
    return true;
  // Another node takes an empty folder of this one for that of one that ended.
  if (errno == ENOENT && make_parent(parent))
    return ::mkdir(folder.c_str(), 0755) == 0;
  return fs::is_directory(folder, error);
}

bool is_real_time_trap(const cgroup_parent& parent,
                       const instance_bounds& bounds) {
  return bounds.real_time && parent.controllers.count("cpu") != 0
         && ::access((parent.folder / "cpu.rt_runtime_us").c_str(), F_OK) == 0;
}

} // namespace

instance_cgroup instance_cgroup::make(const cgroup_place& place,
                                      const std::string& instance,
                                      const instance_bounds& bounds) {
  instance_cgroup result;
  for (const auto& parent : place.parents) {
    const auto folder = parent.folder / instance;
    if (is_real_time_trap(parent, bounds) || !make_anew(parent, folder))
      continue;
    bound(folder, parent, bounds);
    result.folders_.push_back(folder);
  }
  return result;
}

instance_cgroup instance_cgroup::recall(const fs::path& records) {
  instance_cgroup result;
  std::error_code error;
  const auto text = fs::read_symlink(records / record_name, error).native();
  std::string_view rest{text};
  while (!rest.empty()) {
    const auto end = std::min(rest.find(separator), rest.size());
    // It is the node's own record, but whoever can write there must not have
    // it remove folders elsewhere.
    const fs::path folder{std::string{rest.substr(0, end)}};
    if (folder.is_absolute() && folder.filename() == records.filename()
        && ::access((folder / "cgroup.procs").c_str(), F_OK) == 0)
      result.folders_.push_back(folder);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return result;
}

instance_cgroup instance_cgroup::named(const cgroup_place& place,
                                       const std::string& instance) {
  instance_cgroup result;
  std::error_code error;
  for (const auto& x : place.parents)
    if (fs::is_directory(x.folder / instance, error))
      result.folders_.push_back(x.folder / instance);
  return result;
}

void instance_cgroup::record(const fs::path& records) const {
  const auto link = records / record_name;
  std::string text;
  for (const auto& x : folders_)
    text += (text.empty() ? "" : std::string{separator}) + x.native();
  ::unlink(link.c_str());
  if (!text.empty() && ::symlink(text.c_str(), link.c_str()) != 0)
    return; // It is found by its name, as long as the place is the same.
}

bool instance_cgroup::kill() const {
  auto any = false;
  for (auto round = 0; round < kill_rounds; ++round) {
    auto now = false;
    for (const auto& x : folders_)
      now = kill_members_of(x) || now;
    if (!now)
      break;
    any = true;
    ::poll(nullptr, 0, kill_round_ms);
  }
  return any;
}

bool instance_cgroup::remove() const {
  auto all = true;
  for (const auto& x : folders_)
    all = remove_cgroup(x) && all;
  return all;
}

std::vector<std::string>
remove_other_cgroups(const cgroup_place& place,
                     const std::set<std::string>& known) {
  std::set<std::string> left;
  for (const auto& parent : place.parents) {
    std::error_code error;
    std::vector<fs::path> others;
    for (fs::directory_iterator i{parent.folder, error}, end;
         !error && i != end; i.increment(error))
      if (i->is_directory(error)
          && known.count(i->path().filename().native()) == 0)
        others.push_back(i->path());
    for (const auto& x : others) {
      kill_members_of(x);
      if (!remove_cgroup(x))
        left.insert(x.filename().native());
    }
  }
  return {left.begin(), left.end()};
}

long long cpu_weight_of(double cores) {
  constexpr double least = 1;
  constexpr double most = 10'000;
  return std::llround(std::clamp(cores * 100, least, most));
}

long long cpu_shares_of(double cores) {
  constexpr double least = 2;
  constexpr double most = 262'144;
  return std::llround(std::clamp(cores * 1024, least, most));
}

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
