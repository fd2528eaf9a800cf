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

/// User and system time: fields 14 and 15 of proc_pid_stat(5). The name of the
/// program, field 2, may have blanks and brackets in it.
double cpu_seconds(const std::string& stat) {
  const auto name_end = stat.rfind(')');
  if (name_end == std::string::npos)
    return 0;
  std::istringstream in{stat.substr(name_end + 1)};
  std::string skipped;
  for (int field = 3; field < 14; ++field)
    in >> skipped;
  double user = 0;
  double system = 0;
  in >> user >> system;
  return in ? (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK)) : 0;
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

own_cost read_own_cost(const fs::path& process) {
  own_cost result;
  result.cpu_seconds = cpu_seconds(text_of(process / "stat"));
  const auto memory = text_of(process / "smaps_rollup");
  result.resident_bytes = value_of(memory, "Rss") * kib;
  result.pss_bytes = value_of(memory, "Pss") * kib;
  result.written_bytes = value_of(text_of(process / "io"), "write_bytes");
  result.open_files = entries(process / "fd");
  return result;
}

} // namespace roscell
