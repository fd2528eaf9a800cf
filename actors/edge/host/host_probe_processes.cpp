#include "actors/edge/host/host_probe_processes.hpp"

#include "actors/edge/host/host_probe_files.hpp"

#include <array>
#include <filesystem>

#include <unistd.h>

namespace roscell {

namespace {

/// The fields of /proc/PID/stat that follow the command's name, which can hold
/// anything. proc(5) counts them from 3.
constexpr std::size_t first_field = 3;
constexpr std::size_t last_field = 24;
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

} // namespace

process_usage usage_of_sessions(const std::set<pid_t>& sessions,
                                const std::string& root) {
  process_usage result;
  if (sessions.empty())
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
        && sessions.count(static_cast<pid_t>(fields[6])) != 0) {
      add(fields, result);
      result.pids.insert(static_cast<pid_t>(*pid));
    }
  }
  return result;
}

} // namespace roscell
