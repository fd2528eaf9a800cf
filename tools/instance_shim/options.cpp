#include "tools/instance_shim/options.hpp"

#include <grp.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// Sets of this version have two words of 32 bits.
constexpr auto words = _LINUX_CAPABILITY_U32S_3;
constexpr int word_bits = 32;

/// Those after the last one that the kernel knows are refused.
constexpr int most_capabilities = 64;

bool bit_of(std::uint64_t set, int number) {
  return (set >> number & 1) != 0;
}

/// Reads a number up to `end`, and goes behind that.
bool take_number(const char*& at, char end, id_t& result) {
  char* behind = nullptr;
  errno = 0;
  const auto value = std::strtoul(at, &behind, 10);
  // The highest one means "no change" to the kernel.
  if (*at < '0' || *at > '9' || errno != 0 || value >= 0xFFFFFFFF
      || (*behind != end && *behind != '\0'))
    return false;
  result = static_cast<id_t>(value);
  at = *behind == '\0' ? behind : behind + 1;
  return true;
}

std::uint64_t permitted() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[words] = {};
  if (::syscall(SYS_capget, &header, data) != 0)
    return 0;
  return data[0].permitted | std::uint64_t{data[1].permitted} << word_bits;
}

bool set_capabilities(std::uint64_t set) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[words] = {};
  for (auto i = 0; i < words; ++i) {
    const auto word = static_cast<std::uint32_t>(set >> (i * word_bits));
    data[i] = {word, word, word};
  }
  return ::syscall(SYS_capset, &header, data) == 0;
}

/// Whoever is root gets what is in this set by running a program. Who may not
/// make it smaller cannot become root either.
void bound_capabilities(std::uint64_t set) {
  for (auto i = 0; i < most_capabilities; ++i)
    if (!bit_of(set, i) && ::prctl(PR_CAPBSET_DROP, i) != 0 && errno == EINVAL)
      return;
}

bool become_user(const identity& wanted) {
  return ::prctl(PR_SET_KEEPCAPS, 1) == 0
         && ::setgroups(wanted.group_count, wanted.groups) == 0
         && ::setresgid(wanted.group, wanted.group, wanted.group) == 0
         && ::setresuid(wanted.user, wanted.user, wanted.user) == 0;
}

/// Who is not root would lose its capabilities by running a program.
void hand_on(std::uint64_t set) {
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  for (auto i = 0; i < most_capabilities; ++i)
    if (bit_of(set, i))
      ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, i, 0, 0);
}

} // namespace

bool read_user(const char* text, identity& result) {
  id_t user = 0;
  id_t group = 0;
  if (!take_number(text, ':', user) || !take_number(text, ',', group))
    return false;
  result.user = user;
  result.group = group;
  while (*text != '\0') {
    if (result.group_count == identity::most_groups
        || !take_number(text, ',', group))
      return false;
    result.groups[result.group_count++] = group;
  }
  return result.has_user = true;
}

bool read_capabilities(const char* text, identity& result) {
  char* end = nullptr;
  errno = 0;
  result.capabilities = std::strtoull(text, &end, 16);
  return result.has_capabilities = end != text && *end == '\0' && errno == 0;
}

bool take_identity(const identity& wanted) {
  const auto kept =
      wanted.has_capabilities ? wanted.capabilities & permitted() : permitted();
  if (wanted.has_capabilities)
    bound_capabilities(kept);
  if (wanted.has_user && !become_user(wanted))
    return false;
  if (!wanted.has_capabilities)
    return true;
  if (!set_capabilities(kept))
    return false;
  hand_on(kept);
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
}

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

bool read_attachment(const char* word, attachment& result) {
  const auto terminal = std::strcmp(word, "terminal") == 0;
  result = terminal ? attachment::terminal : attachment::pipes;
  return terminal || std::strcmp(word, "pipes") == 0;
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
      2,
      "usage: roscell-instance-shim {--dir DIR --log-bytes N | --exit FILE | "
      "--attached pipes|terminal [--lifeline SOCKET]} "
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
    {"--attached", [](const char* x,
                      options& to) { return read_attachment(x, to.attached); }},
    {"--lifeline",
     [](const char* x, options& to) { return (to.lifeline = x) != nullptr; }},
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
  const auto attached = result.attached != attachment::none;
  const auto logs = result.directory != nullptr && result.log_bytes > 0
                    && result.exit_file == nullptr && !attached;
  const auto only_records = result.directory == nullptr && result.log_bytes == 0
                            && (result.exit_file != nullptr) != attached;
  const auto has_command = i + 1 < argc && std::strcmp(argv[i], "--") == 0;
  return ((logs || only_records) && has_command) || usage();
}

} // namespace roscell::shim
