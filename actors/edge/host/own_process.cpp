#include "actors/edge/host/own_process.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/process/process_identity.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
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

namespace {

/// More than a UUID and the end of its line.
constexpr size_t most_bytes = 64;

bool is_of_id(unsigned char c) {
  return std::isalnum(c) != 0 || c == '-';
}

} // namespace

std::string this_boot(const fs::path& proc) {
  auto id = read_small_file(proc / "sys/kernel/random/boot_id", most_bytes);
  const auto first = identify(1, proc);
  if (!id || !first)
    return {};
  size_t end = 0;
  while (end < id->size() && is_of_id((*id)[end]))
    ++end;
  if (end == 0)
    return {};
  return id->substr(0, end) + '/' + std::to_string(first->start_time);
}

std::size_t raise_descriptor_limit() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0)
    return 0;
  auto raised = limit;
  raised.rlim_cur = raised.rlim_max;
  if (::setrlimit(RLIMIT_NOFILE, &raised) == 0)
    limit = raised;
  return limit.rlim_cur;
}

namespace {

constexpr const char* shim_name = "roscell-instance-shim";

fs::path private_folder(const fs::path& bin) {
  return bin.parent_path() / "lib" / "roscell";
}

} // namespace

fs::path program_folder() {
  std::error_code problem;
  return fs::read_symlink("/proc/self/exe", problem).parent_path();
}

fs::path find_private(const fs::path& bin, const std::string& name) {
  std::error_code problem;
  const auto beside = bin / name;
  return fs::exists(beside, problem) ? beside : private_folder(bin) / name;
}

fs::path find_shim(const fs::path& bin) {
  return find_private(bin, shim_name);
}

fs::path installed_skills(const fs::path& bin) {
  return private_folder(bin) / "skills";
}

bool names_folder(const std::vector<fs::path>& folders,
                  const fs::path& folder) {
  return std::any_of(folders.begin(), folders.end(), [&](const auto& x) {
    std::error_code problem;
    return fs::equivalent(x, folder, problem);
  });
}

} // namespace roscell
