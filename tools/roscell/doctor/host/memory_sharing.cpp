#include "tools/roscell/doctor/host/memory_sharing.hpp"

#include "tools/roscell/doctor/host/process_maps.hpp"

#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// RTPS 9.6.2.3: where the ports of domain 0 begin, and how many each has.
constexpr int first_port = 7400;
constexpr int ports_of_a_domain = 250;

/// Of "fastrtps_port7411"; nothing for a file that is no port.
std::optional<int> domain_of(const std::string& name) {
  constexpr std::string_view word = "_port";
  const auto at = name.find(word);
  int port = 0;
  if (at == name.npos)
    return std::nullopt;
  const auto* digits = name.data() + at + word.size();
  const auto end = std::from_chars(digits, name.data() + name.size(), port);
  if (end.ec != std::errc{} || port < first_port)
    return std::nullopt;
  return (port - first_port) / ports_of_a_domain;
}

int number_of(const std::string& digits) {
  int result = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), result);
  return result;
}

/// As the kernel writes it in /proc/PID/maps.
std::string device_text(dev_t device) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%02x:%02x", major(device),
                minor(device));
  return text.data();
}

std::string first_line(const fs::path& file) {
  std::string result;
  std::ifstream in{file};
  std::getline(in, result);
  return result;
}

/// A program whose namespace may not be seen is none.
std::optional<dds_program> read_program(const mapped_file& seen) {
  dds_program result;
  std::error_code error;
  struct stat owner {};
  result.network = fs::read_symlink(seen.process / "ns/net", error);
  if (error || ::stat(seen.process.c_str(), &owner) != 0)
    return std::nullopt;
  result.pid = number_of(seen.process.filename().string());
  result.name = first_line(seen.process / "comm");
  result.user = owner.st_uid;
  result.memory = seen.device;
  result.open_to_all = true;
  return result;
}

/// Whether all users may write to a file that a program has mapped.
bool is_open(const mapped_file& seen, const fs::path& folder) {
  struct stat info {};
  const auto file = seen.process / "root" / folder.relative_path() / seen.name;
  return ::stat(file.c_str(), &info) != 0 || (info.st_mode & S_IWOTH) != 0;
}

using group = std::vector<const dds_program*>;

/// "talker (pid 12, user 0)", "... and 2 more".
std::string names_of(const group& programs) {
  const auto& x = *programs.front();
  auto text = x.name + " (pid " + std::to_string(x.pid) + ", user "
              + std::to_string(x.user) + ")";
  if (programs.size() > 1)
    text += " and " + std::to_string(programs.size() - 1) + " more";
  return text;
}

/// The programs that should hear each other, by what keeps them apart. The one
/// that the others are compared with comes first.
template <class Key>
std::vector<group> parts_of(const group& programs, Key key,
                            const std::string& first) {
  std::map<std::string, group> by_key;
  for (const auto* x : programs)
    by_key[key(*x)].push_back(x);
  std::vector<group> result;
  for (auto& [name, part] : by_key)
    result.insert(name == first ? result.begin() : result.end(),
                  std::move(part));
  return result;
}

/// What most of them are.
template <class Key>
std::string most_common(const group& programs, Key key) {
  std::map<std::string, int> counts;
  for (const auto* x : programs)
    ++counts[key(*x)];
  return std::max_element(
             counts.begin(), counts.end(),
             [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

constexpr auto no_data =
    "they see each other and each other's topics, and none of the data arrive";

void judge_mounts(const group& programs, const std::string& where,
                  const std::string& host_memory, findings& result) {
  const auto parts = parts_of(
      programs, [](const auto& x) { return x.memory; }, host_memory);
  for (size_t i = 1; i < parts.size(); ++i)
    result.push_back({judgement::broken,
                      where + names_of(parts[i]) + " has another /dev/shm than "
                          + names_of(parts[0]),
                      no_data,
                      "docker run --network=host --ipc=host --user "
                          + std::to_string(parts[0].front()->user) + " IMAGE"});
}

void judge_users(const group& programs, const std::string& where,
                 findings& result) {
  const auto user = [](const auto& x) { return std::to_string(x.user); };
  const auto parts = parts_of(programs, user, most_common(programs, user));
  const auto is_closed = [](const auto* x) { return !x->open_to_all; };
  if (!std::any_of(programs.begin(), programs.end(), is_closed))
    return;
  for (size_t i = 1; i < parts.size(); ++i)
    result.push_back({judgement::broken,
                      where + names_of(parts[i]) + " may not share memory with "
                          + names_of(parts[0]),
                      no_data,
                      "sudo -u '#" + user(*parts[0].front()) + "' COMMAND"});
}

} // namespace

dds_programs find_dds_programs(const fs::path& proc, const fs::path& folder) {
  std::map<fs::path, std::optional<dds_program>> found;
  dds_programs result;
  result.closed =
      visit_mapped_files(proc, folder, [&](const mapped_file& seen) {
        if (!is_dds_file(seen.name))
          return;
        const auto [at, is_new] = found.try_emplace(seen.process);
        if (is_new)
          at->second = read_program(seen);
        auto& program = at->second;
        if (!program)
          return;
        program->open_to_all = program->open_to_all && is_open(seen, folder);
        if (const auto domain = domain_of(seen.name))
          program->domains.insert(*domain);
      });
  for (auto& [process, program] : found)
    if (program)
      result.all.push_back(std::move(*program));
    else
      ++result.closed;
  std::sort(result.all.begin(), result.all.end(),
            [](const auto& a, const auto& b) { return a.pid < b.pid; });
  return result;
}

findings judge_memory_sharing(const dds_programs& programs,
                              const std::string& host_memory) {
  std::map<std::pair<std::string, int>, group> neighbours;
  for (const auto& x : programs.all)
    for (const auto domain : x.domains)
      neighbours[{x.network, domain}].push_back(&x);
  findings result;
  for (const auto& [place, group_of_all] : neighbours) {
    const auto where = "domain " + std::to_string(place.second) + ": ";
    judge_mounts(group_of_all, where, host_memory, result);
    for (const auto& part : parts_of(
             group_of_all, [](const auto& x) { return x.memory; }, host_memory))
      judge_users(part, where, result);
  }
  if (!result.empty())
    return result;
  const auto seen = "none is kept from another's memory; programs: "
                    + std::to_string(programs.all.size());
  if (programs.closed == 0)
    return {{judgement::ok, seen}};
  return {{judgement::skipped,
           seen + ", and processes that this user may not look at: "
               + std::to_string(programs.closed)}};
}

findings check_memory_sharing(const checked_host& host) {
  const auto folder = fs::path{host.dev} / "shm";
  struct stat own {};
  const bool known = ::stat(folder.c_str(), &own) == 0;
  return judge_memory_sharing(find_dds_programs(host.proc, folder),
                              known ? device_text(own.st_dev) : "");
}

} // namespace roscell::cli
