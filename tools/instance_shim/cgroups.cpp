#include "tools/instance_shim/cgroups.hpp"

#include <fcntl.h>
#include <linux/sched.h>
#include <poll.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// A file of a cgroup.
struct path_in {
  path_in(const char* folder, const char* name) {
    std::snprintf(text, sizeof(text), "%s/%s", folder, name);
  }

  char text[1024];
};

/// Of version 1: one thread is moved without a wait for the whole host.
constexpr const char* one_thread = "tasks";

bool is_unified(const char* folder) {
  return ::access(path_in{folder, "cgroup.controllers"}.text, F_OK) == 0;
}

bool put(const char* folder, const char* name, const char* word) {
  const auto file = ::open(path_in{folder, name}.text, O_WRONLY | O_CLOEXEC);
  if (file < 0)
    return false;
  const auto size = static_cast<ssize_t>(std::strlen(word));
  const auto done = ::write(file, word, static_cast<std::size_t>(size)) == size;
  const auto why = errno;
  ::close(file);
  errno = why;
  return done;
}

/// Of a small file; an empty text where there is none.
void get(const char* folder, const char* name, char* text, std::size_t room) {
  const auto file = ::open(path_in{folder, name}.text, O_RDONLY | O_CLOEXEC);
  const auto size = file < 0 ? -1 : ::read(file, text, room - 1);
  text[size > 0 ? size : 0] = '\0';
  if (file >= 0)
    ::close(file);
}

/// The number of a line "KEY NUMBER"; negative: there is none.
long long value_of(const char* text, const char* key) {
  const auto length = std::strlen(key);
  for (const auto* line = text; line != nullptr && *line != '\0';
       line = std::strchr(line, '\n')) {
    line += *line == '\n' ? 1 : 0;
    if (std::strncmp(line, key, length) == 0 && line[length] == ' ')
      return std::atoll(line + length + 1);
  }
  return -1;
}

bool is_populated(const char* folder) {
  char text[256];
  get(folder, "cgroup.events", text, sizeof(text));
  return value_of(text, "populated") == 1;
}

/// A number may be cut at the end of what was read: the rest follows.
void kill_listed(const char* folder) {
  char text[4096];
  const auto file =
      ::open(path_in{folder, "cgroup.procs"}.text, O_RDONLY | O_CLOEXEC);
  pid_t number = 0;
  for (ssize_t size = 0;
       file >= 0 && (size = ::read(file, text, sizeof(text))) > 0;)
    for (const auto* at = text; at != text + size; ++at)
      if (*at >= '0' && *at <= '9') {
        number = number * 10 + (*at - '0');
      } else if (number > 0) {
        ::kill(number, SIGKILL);
        number = 0;
      }
  if (file >= 0)
    ::close(file);
}

/// The kernel freezes one after the other; a moment is given to it.
void freeze(const char* folder) {
  constexpr auto rounds = 10;
  char state[32];
  if (!put(folder, "freezer.state", "FROZEN"))
    return;
  for (auto i = 0; i < rounds; ++i) {
    get(folder, "freezer.state", state, sizeof(state));
    if (std::strncmp(state, "FROZEN", 6) == 0)
      return;
    ::poll(nullptr, 0, 1);
  }
}

bool is_empty(const char* folder) {
  char text[2];
  get(folder, "cgroup.procs", text, sizeof(text));
  return text[0] == '\0' && !is_populated(folder);
}

void kill_in(const char* folder) {
  if (!is_unified(folder) || !put(folder, "cgroup.kill", "1"))
    kill_listed(folder);
}

} // namespace

pid_t fork_into(const cgroup_list& folders, bool& inside) {
  inside = false;
  const auto unified = folders.count == 1 && is_unified(folders.at[0]);
  const auto folder =
      unified ? ::open(folders.at[0], O_PATH | O_DIRECTORY | O_CLOEXEC) : -1;
  if (folder >= 0) {
    clone_args request{};
    request.flags = CLONE_INTO_CGROUP;
    request.exit_signal = SIGCHLD;
    request.cgroup = static_cast<std::uint64_t>(folder);
    const auto child =
        static_cast<pid_t>(::syscall(SYS_clone3, &request, sizeof(request)));
    ::close(folder);
    inside = child >= 0;
    if (inside)
      return child;
  }
  return ::fork();
}

void enter(const cgroup_list& folders) {
  for (auto i = 0; i < folders.count; ++i)
    if (!put(folders.at[i],
             is_unified(folders.at[i]) ? "cgroup.procs" : one_thread, "0"))
      ::dprintf(STDERR_FILENO,
                "[shim: it runs without limits: cannot enter '%s': %s]\n",
                folders.at[i], std::strerror(errno));
}

bool kill_members(const cgroup_list& folders) {
  auto any = false;
  for (auto i = 0; i < folders.count; ++i)
    any = any || !is_empty(folders.at[i]);
  if (!any)
    return false;
  for (auto i = 0; i < folders.count; ++i)
    freeze(folders.at[i]);
  for (auto i = 0; i < folders.count; ++i)
    kill_in(folders.at[i]);
  for (auto i = 0; i < folders.count; ++i)
    put(folders.at[i], "freezer.state", "THAWED");
  return any;
}

memory_story read_memory(const cgroup_list& folders) {
  memory_story result;
  char text[1024];
  for (auto i = 0; i < folders.count; ++i) {
    const auto unified = is_unified(folders.at[i]);
    get(folders.at[i], unified ? "memory.events" : "memory.oom_control", text,
        sizeof(text));
    const auto kills = value_of(text, "oom_kill");
    result.kills = kills > result.kills ? kills : result.kills;
    get(folders.at[i], unified ? "memory.peak" : "memory.max_usage_in_bytes",
        text, sizeof(text));
    if (text[0] >= '0' && text[0] <= '9')
      result.most = std::atoll(text);
  }
  return result;
}

memory_story read_own_memory() {
  constexpr long long no_bound = 1LL << 60;
  constexpr cgroup_list places[] = {{{"/sys/fs/cgroup"}, 1},
                                    {{"/sys/fs/cgroup/memory"}, 1}};
  char text[32];
  for (const auto& x : places) {
    get(x.at[0], is_unified(x.at[0]) ? "memory.max" : "memory.limit_in_bytes",
        text, sizeof(text));
    if (text[0] >= '0' && text[0] <= '9' && std::atoll(text) < no_bound)
      return read_memory(x);
  }
  return {};
}

} // namespace roscell::shim
