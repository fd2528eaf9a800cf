#include "tools/instance_shim/child.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// Deeper ones come up when those above them have ended.
constexpr int most_levels = 64;

/// The children that one thread has started, as text: "PID PID ".
bool read_children(pid_t process, const char* thread, char* text, size_t room) {
  char path[64];
  std::snprintf(path, sizeof(path), "/proc/%d/task/%.16s/children", process,
                thread);
  auto fd = ::open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return false;
  auto size = ::read(fd, text, room - 1);
  ::close(fd);
  if (size <= 0)
    return false;
  text[size] = '\0';
  // A list that was cut may end with a part of a number.
  if (text[size - 1] != ' ')
    *(std::strrchr(text, ' ') + 1) = '\0';
  return true;
}

DIR* threads_of(pid_t process) {
  char path[64];
  std::snprintf(path, sizeof(path), "/proc/%d/task", process);
  return ::opendir(path);
}

bool visit_below(pid_t process, visitor visit, void* context, int level) {
  char text[4096];
  auto any = false;
  auto* threads = level < most_levels ? threads_of(process) : nullptr;
  if (threads == nullptr)
    return false;
  while (const auto* entry = ::readdir(threads)) {
    if (entry->d_name[0] == '.'
        || !read_children(process, entry->d_name, text, sizeof(text)))
      continue;
    any = true;
    char* rest = nullptr;
    for (const char* at = text; *at >= '0' && *at <= '9'; at = rest + 1) {
      auto child = static_cast<pid_t>(std::strtol(at, &rest, 10));
      visit_below(child, visit, context, level + 1);
      visit(child, context);
    }
  }
  ::closedir(threads);
  return any;
}

/// Of "NAME:\tHEX" in a status file.
unsigned long long mask_in(const char* text, const char* name) {
  const auto* at = std::strstr(text, name);
  return at != nullptr ? std::strtoull(at + std::strlen(name), nullptr, 16) : 0;
}

/// What a process does with signals, a bit for each.
struct signal_masks {
  unsigned long long caught = 0;
  unsigned long long blocked = 0; ///< By one thread.
  unsigned long long ignored = 0;
};

/// What the status of one thread says.
bool read_masks(pid_t process, const char* thread, signal_masks& masks) {
  char path[64];
  char text[4096];
  std::snprintf(path, sizeof(path), "/proc/%d/task/%.16s/status", process,
                thread);
  auto fd = ::open(path, O_RDONLY | O_CLOEXEC);
  auto size = fd < 0 ? -1 : ::read(fd, text, sizeof(text) - 1);
  if (fd >= 0)
    ::close(fd);
  if (size <= 0)
    return false;
  text[size] = '\0';
  masks = {mask_in(text, "\nSigCgt:"), mask_in(text, "\nSigBlk:"),
           mask_in(text, "\nSigIgn:")};
  return true;
}

} // namespace

bool visit_descendants(pid_t process, visitor visit, void* context) {
  return visit_below(process, visit, context, 0);
}

bool takes_signal(pid_t process, int number) {
  const auto bit = 1ULL << (number - 1);
  auto* threads = threads_of(process);
  auto any = false;
  auto all_block = true;
  auto catches = false;
  while (const auto* entry =
             threads != nullptr ? ::readdir(threads) : nullptr) {
    signal_masks masks;
    if (entry->d_name[0] == '.' || !read_masks(process, entry->d_name, masks))
      continue;
    any = true;
    catches = catches || (masks.caught & bit) != 0;
    // The kernel gives it to any thread that lets it through.
    all_block = all_block && (masks.blocked & bit) != 0;
  }
  if (threads != nullptr)
    ::closedir(threads);
  return any && (catches || all_block);
}

bool ignores_signal(pid_t process, int number) {
  char thread[16];
  signal_masks masks;
  std::snprintf(thread, sizeof(thread), "%d", process);
  return read_masks(process, thread, masks)
         && (masks.ignored & 1ULL << (number - 1)) != 0;
}

} // namespace roscell::shim
