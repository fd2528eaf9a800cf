#include "tools/instance_shim/options.hpp"

#include <sched.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// A log shorter than this helps nobody; a longer one than a TiB is a typo.
constexpr std::uint64_t least_log_bytes = 1024;
constexpr std::uint64_t most_log_bytes = 1ULL << 40;

bool read_bytes(const char* text, std::uint64_t& result) {
  char* end = nullptr;
  if (*text < '0' || *text > '9')
    return false;
  result = std::strtoull(text, &end, 10);
  return *end == '\0' && result >= least_log_bytes && result <= most_log_bytes;
}

bool read_signal(const char* text, int& result) {
  constexpr long last_signal = 31;
  char* end = nullptr;
  const auto value = std::strtol(text, &end, 10);
  result = static_cast<int>(value);
  return end != text && *end == '\0' && value >= 1 && value <= last_signal;
}

bool add_cgroup(const char* folder, cgroup_list& result) {
  if (folder[0] != '/' || result.count == cgroup_list::most)
    return false;
  result.at[result.count++] = folder;
  return true;
}

struct policy_word {
  const char* word;
  int policy;
};

constexpr policy_word policies[] = {{"other", SCHED_OTHER},
                                    {"batch", SCHED_BATCH},
                                    {"idle", SCHED_IDLE},
                                    {"fifo", SCHED_FIFO},
                                    {"rr", SCHED_RR}};

/// The number up to `end`, which is passed over.
bool read_number(const char*& text, char end, long least, long most,
                 int& result) {
  char* rest = nullptr;
  const auto value = std::strtol(text, &rest, 10);
  const auto good =
      rest != text && *rest == end && value >= least && value <= most;
  result = static_cast<int>(value);
  text = rest + 1;
  return good;
}

/// "POLICY:PRIORITY:NICE"; the kernel judges the numbers.
bool read_scheduling(const char* text, scheduling& result) {
  constexpr long most_priority = 99;
  const auto* colon = std::strchr(text, ':');
  for (const auto& x : policies) {
    const auto length = std::strlen(x.word);
    if (colon == nullptr || static_cast<std::size_t>(colon - text) != length
        || std::strncmp(text, x.word, length) != 0)
      continue;
    const auto* rest = colon + 1;
    result.policy = x.policy;
    return read_number(rest, ':', 0, most_priority, result.priority)
           && read_number(rest, '\0', -20, 19, result.nice);
  }
  return false;
}

bool usage() {
  ::dprintf(
      2, "usage: roscell-instance-shim {--dir DIR --log-bytes N | --exit FILE} "
         "[--fence FILE] [--cwd DIR] [--stop-signal S] [--cgroup FOLDER]... "
         "[--scheduling POLICY:PRIORITY:NICE] [--user UID:GID[,GROUP...]] "
         "[--capabilities HEX] -- COMMAND [ARGS...]\n"
         "N is a whole number of at least 1024, S one from 1 to 31, POLICY is "
         "other, batch, idle, fifo or rr.\n");
  return false;
}

using taker = bool (*)(const char* value, options& result);

struct option {
  const char* name;
  taker take; ///< False: the value makes no sense.
};

constexpr option all_options[] = {
    {"--dir",
     [](const char* x, options& to) { return (to.directory = x) != nullptr; }},
    {"--cwd", [](const char* x,
                 options& to) { return (to.working_dir = x) != nullptr; }},
    {"--fence",
     [](const char* x, options& to) { return (to.fence = x) != nullptr; }},
    {"--exit",
     [](const char* x, options& to) { return (to.exit_file = x) != nullptr; }},
    {"--log-bytes",
     [](const char* x, options& to) { return read_bytes(x, to.log_bytes); }},
    {"--stop-signal",
     [](const char* x, options& to) { return read_signal(x, to.stop_signal); }},
    {"--cgroup",
     [](const char* x, options& to) { return add_cgroup(x, to.cgroups); }},
    {"--scheduling",
     [](const char* x, options& to) { return read_scheduling(x, to.request); }},
    {"--user", [](const char* x, options& to) { return read_user(x, to.who); }},
    {"--capabilities",
     [](const char* x, options& to) { return read_capabilities(x, to.who); }},
};

bool take(const char* name, const char* value, options& result) {
  for (const auto& x : all_options)
    if (std::strcmp(name, x.name) == 0)
      return x.take(value, result);
  return false;
}

} // namespace

bool read_options(int argc, char** argv, options& result) {
  auto i = 1;
  for (; i + 1 < argc && std::strcmp(argv[i], "--") != 0; i += 2)
    if (!take(argv[i], argv[i + 1], result))
      return usage();
  result.command = argv + i + 1;
  const auto logs = result.directory != nullptr && result.log_bytes > 0
                    && result.exit_file == nullptr;
  const auto only_records = result.directory == nullptr && result.log_bytes == 0
                            && result.exit_file != nullptr;
  const auto has_command = i + 1 < argc && std::strcmp(argv[i], "--") == 0;
  return ((logs || only_records) && has_command) || usage();
}

} // namespace roscell::shim
