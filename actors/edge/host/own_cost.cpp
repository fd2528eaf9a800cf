#include "actors/edge/host/own_cost.hpp"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

namespace roscell {

namespace {

namespace fs = std::filesystem;

constexpr double kib = 1024;

std::string text_of(const fs::path& file) {
  std::ifstream in{file};
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

/// The number behind "KEY:"; 0 if there is none.
double value_of(const std::string& text, const std::string& key) {
  const auto found = ("\n" + text).find("\n" + key + ":");
  if (found == std::string::npos)
    return 0;
  std::istringstream in{text.substr(found + key.size() + 1)};
  double result = 0;
  in >> result;
  return in ? result : 0;
}

/// Times in the fields of proc_pid_stat(5), from its third one on. The name of
/// the program, field 2, may have blanks and brackets in it.
void take_times(const std::string& stat, own_cost& to) {
  constexpr int user_field = 14;
  constexpr int start_field = 22;
  const auto ticks_per_s = static_cast<double>(sysconf(_SC_CLK_TCK));
  const auto name_end = stat.rfind(')');
  if (name_end == std::string::npos)
    return;
  std::istringstream in{stat.substr(name_end + 1)};
  std::string skipped;
  for (int field = 3; field < user_field; ++field)
    in >> skipped;
  double user = 0;
  double system = 0;
  if (in >> user >> system)
    to.cpu_seconds = (user + system) / ticks_per_s;
  for (int field = user_field + 2; field < start_field; ++field)
    in >> skipped;
  if (double start = 0; in >> start)
    to.started_s = start / ticks_per_s;
}

double entries(const fs::path& folder) {
  std::error_code failed;
  double result = 0;
  for (fs::directory_iterator i{folder, failed}, end; !failed && i != end;
       i.increment(failed))
    ++result;
  return result;
}

} // namespace

double read_boot_time(const fs::path& file) {
  std::ifstream in{file};
  std::string key;
  double result = 0;
  while (in >> key)
    if (key == "btime")
      return in >> result ? result : 0;
  return 0;
}

own_cost read_own_cost(const fs::path& process) {
  own_cost result;
  take_times(text_of(process / "stat"), result);
  const auto memory = text_of(process / "smaps_rollup");
  result.resident_bytes = value_of(memory, "Rss") * kib;
  result.pss_bytes = value_of(memory, "Pss") * kib;
  result.written_bytes = value_of(text_of(process / "io"), "write_bytes");
  result.open_files = entries(process / "fd");
  return result;
}

} // namespace roscell
