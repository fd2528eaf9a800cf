#include "actors/edge/host/host_probe_processes.hpp"

#include "actors/edge/host/host_probe_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include <unistd.h>

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

} // namespace roscell
