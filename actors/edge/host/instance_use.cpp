#include "actors/edge/host/instance_use.hpp"

#include "actors/edge/cgroup/cgroup_tables.hpp"
#include "actors/edge/host/host_probe_files.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>

namespace roscell {

namespace {

/// The fields of /proc/PID/stat that follow the command's name, which can hold
/// anything. proc(5) counts them from 3.
constexpr std::size_t first_field = 3;
constexpr std::size_t last_field = 24;
constexpr std::size_t max_cgroup_bytes = 8192;
constexpr std::size_t container_digits = 64;
using stat_fields = std::array<long long, last_field + 1>;

bool read_fields(std::string_view text, stat_fields& fields) {
  auto name_end = text.rfind(')');
  if (name_end == std::string_view::npos)
    return false;
  text.remove_prefix(name_end + 1);
  take_word(text); // The state, a letter.
  for (auto i = first_field + 1; i <= last_field; ++i) {
    auto value = to_number(take_word(text));
    if (!value)
      return false;
    fields[i] = *value;
  }
  return true;
}

void add(const stat_fields& fields, process_usage& to) {
  static const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  static const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
  auto time = fields[14] + fields[15] + fields[16] + fields[17];
  to.cpu_seconds += static_cast<double>(time) / ticks;
  to.rss_mib += static_cast<double>(fields[24]) * page / (1024.0 * 1024.0);
  ++to.processes;
}

/// Whether a process is in one of these containers. Its cgroups are, for
/// example, "/docker/ID", "/machine.slice/libpod-ID.scope" or "/../ID".
bool is_in(const std::set<std::string>& containers, const std::string& folder) {
  constexpr std::string_view digits = "0123456789abcdef";
  if (containers.empty())
    return false;
  const auto text =
      read_file(folder + "/cgroup", max_cgroup_bytes).value_or("");
  std::string_view rest{text};
  while (!rest.empty()) {
    const auto end = std::min(rest.find_first_not_of(digits), rest.size());
    if (end == container_digits
        && containers.count(std::string{rest.substr(0, end)}) != 0)
      return true;
    rest.remove_prefix(std::min(std::max<std::size_t>(end, 1), rest.size()));
  }
  return false;
}

} // namespace

process_usage usage_of(const own_processes& own, const std::string& root) {
  process_usage result;
  if (own.empty())
    return result;
  std::error_code ec;
  for (std::filesystem::directory_iterator i{root + "/proc", ec}, end;
       !ec && i != end; i.increment(ec)) {
    const auto pid = to_number(i->path().filename().native());
    if (!pid)
      continue;
    stat_fields fields{};
    auto text = read_file(i->path().native() + "/stat", 1024);
    if (text && read_fields(*text, fields)
        && (own.sessions.count(static_cast<pid_t>(fields[6])) != 0
            || is_in(own.containers, i->path().native()))) {
      add(fields, result);
      result.pids.insert(static_cast<pid_t>(*pid));
    }
  }
  return result;
}

namespace {

constexpr std::size_t most_mount_bytes = 4 * 1024 * 1024;
constexpr std::size_t most_children_bytes = 256 * 1024;

/// What one look at the host needs for all instances.
struct sight {
  std::filesystem::path proc;
  std::string root;
  std::vector<cgroup_mount> mounts;
};

using folders = std::vector<std::filesystem::path>;

/// The oldest first: of a shim that is its program.
std::vector<pid_t> children_of(pid_t parent, const sight& host) {
  const auto number = std::to_string(parent);
  const auto text =
      read_file((host.proc / number / "task" / number / "children").native(),
                most_children_bytes)
          .value_or("");
  std::vector<pid_t> result;
  std::string_view rest{text};
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest))
    if (const auto pid = to_number(word))
      result.push_back(static_cast<pid_t>(*pid));
  return result;
}

/// Below the shim, which is outside of it, any child may have left its cgroup;
/// the first that has not counts.
folders folders_of_process(const measured_instance& x,
                           const std::vector<pid_t>& children,
                           const sight& host) {
  for (const auto pid : children) {
    auto found =
        named_cgroup_in(cgroups_of(pid, host.proc), x.instance, host.mounts);
    if (!found.empty())
      return found;
  }
  return {};
}

/// A process of each container that is looked for: an engine names the cgroup
/// after it.
std::map<std::string, folders>
folders_of_containers(const std::vector<measured_instance>& instances,
                      const sight& host) {
  std::map<std::string, folders> result;
  std::vector<std::string> open;
  for (const auto& x : instances)
    if (!process_of(x.container) && !x.container.empty())
      open.push_back(x.container);
  std::error_code error;
  for (std::filesystem::directory_iterator i{host.proc, error}, end;
       !error && i != end && result.size() < open.size(); i.increment(error)) {
    const auto pid = to_number(i->path().filename().native());
    if (!pid)
      continue;
    const auto all = cgroups_of(static_cast<pid_t>(*pid), host.proc);
    for (const auto& id : open)
      if (auto found = named_cgroup_in(all, id, host.mounts); !found.empty())
        result.emplace(id, std::move(found));
  }
  return result;
}

std::optional<instance_use> use_in(const folders& where) {
  const auto read = where.empty() ? std::nullopt : read_use(where);
  if (!read)
    return std::nullopt;
  instance_use result;
  result.memory_mib = read->memory_mib;
  result.memory_limit_mib = read->memory_limit_mib;
  result.cpu_s = read->cpu_s;
  result.memory_kills = read->memory_kills;
  return result;
}

/// Without a cgroup: of all processes of its session, those that are shared
/// counted more than once.
instance_use use_of_session(pid_t shim, const sight& host) {
  const auto read = usage_of({{shim}, {}}, host.root);
  instance_use result;
  if (read.processes == 0)
    return result;
  result.memory_mib = read.rss_mib;
  result.cpu_s = read.cpu_seconds;
  return result;
}

} // namespace

std::vector<measured_use>
uses_of(const std::vector<measured_instance>& instances,
        const std::string& root) {
  sight host{root + "/proc", root, {}};
  host.mounts = cgroup_mounts_in(
      read_file(root + "/proc/self/mountinfo", most_mount_bytes).value_or(""));
  const auto containers = folders_of_containers(instances, host);
  std::vector<measured_use> result;
  for (const auto& x : instances) {
    const auto process = process_of(x.container);
    const auto children =
        process ? children_of(process->pid, host) : std::vector<pid_t>{};
    const auto known = containers.find(x.container);
    auto use = use_in(process ? folders_of_process(x, children, host)
                      : known != containers.end() ? known->second
                                                  : folders{});
    if (!use && process)
      use = use_of_session(process->pid, host);
    if (use && !children.empty())
      use->pid = children.front();
    if (use && *use != instance_use{})
      result.push_back({x.instance, *use});
  }
  return result;
}

} // namespace roscell
