#include "tools/roscell/doctor/host/leftovers.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/host/process_maps.hpp"
#include "tools/roscell/view/format.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// A fence that has passed by less may be one that is just being moved on.
constexpr int64_t fence_grace_ms = 60'000;

constexpr std::string_view semaphore_prefix = "sem.";
constexpr std::string_view mutex_suffix = "_mutex";

bool ends_with(std::string_view text, std::string_view end) {
  return text.size() >= end.size()
         && text.substr(text.size() - end.size()) == end;
}

bool begins_with(std::string_view text, std::string_view begin) {
  return text.substr(0, begin.size()) == begin;
}

bool is_lock(std::string_view name) {
  return ends_with(name, "_el") || ends_with(name, "_sl");
}

/// What a file belongs to: "fastrtps_port7411" of its locks and of
/// "sem.fastrtps_port7411_mutex"; empty for a file of others.
std::string dds_owner(std::string_view name) {
  if (begins_with(name, semaphore_prefix))
    name.remove_prefix(semaphore_prefix.size());
  if (!is_dds_file(std::string{name})
      || name.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyz"
                                "ABCDEFGHIJKLMNOPQRSTUVWXYZ_")
             != name.npos)
    return {};
  if (is_lock(name))
    name.remove_suffix(3);
  else if (ends_with(name, mutex_suffix))
    name.remove_suffix(mutex_suffix.size());
  return std::string{name};
}

/// Whether somebody holds the lock; nothing: this user cannot know. It is given
/// back at once.
std::optional<bool> is_held(const fs::path& lock) {
  const unique_fd file{
      open(lock.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  if (!file)
    return std::nullopt;
  return flock(file.get(), LOCK_EX | LOCK_NB) != 0;
}

/// The files of a folder that processes have mapped.
struct mapped_files {
  std::set<std::string> names;
  bool complete = true; ///< Every process could be looked at.
};

mapped_files find_mapped(const fs::path& folder, const fs::path& proc) {
  mapped_files result;
  const auto closed =
      visit_mapped_files(proc, folder, [&result](const mapped_file& x) {
        result.names.insert(x.name);
      });
  result.complete = closed == 0;
  return result;
}

/// The names of files that belong together.
using dds_group = std::vector<std::string>;

bool is_left(const fs::path& folder, const dds_group& group,
             const mapped_files& mapped) {
  bool has_lock = false;
  for (const auto& name : group) {
    if (mapped.names.count(name) != 0)
      return false;
    if (!is_lock(name))
      continue;
    if (is_held(folder / name).value_or(true))
      return false;
    has_lock = true;
  }
  return has_lock || mapped.complete;
}

std::map<std::string, dds_group> dds_groups(const fs::path& folder) {
  std::map<std::string, dds_group> result;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error)) {
    const auto name = i->path().filename().string();
    if (auto owner = dds_owner(name); !owner.empty())
      result[owner].push_back(name);
  }
  return result;
}

void add_file(leftovers& to, const fs::path& file) {
  struct stat info {};
  if (lstat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode))
    return;
  constexpr uint64_t block = 512;
  to.bytes += static_cast<uint64_t>(info.st_blocks) * block;
  to.files.push_back(file);
}

/// The user whose fences lie in a folder of that name; nothing for others.
std::optional<uid_t> fence_user(std::string_view name) {
  constexpr std::string_view prefix = "roscell-";
  uid_t result = 0;
  if (!begins_with(name, prefix))
    return std::nullopt;
  name.remove_prefix(prefix.size());
  const auto end =
      std::from_chars(name.data(), name.data() + name.size(), result);
  if (end.ec != std::errc{} || end.ptr != name.data() + name.size())
    return std::nullopt;
  return result;
}

/// As `fence_path` names them.
bool is_fence_name(const std::string& name) {
  constexpr size_t digits = 32;
  return name.size() == digits
         && name.find_first_not_of("0123456789abcdef") == name.npos;
}

/// A folder of fences that nobody else than its user has made; nothing if not:
/// everybody may make files in the folder around it.
unique_fd open_fences(const fs::path& path) {
  const auto user = fence_user(path.filename().native());
  struct stat info {};
  if (!user)
    return {};
  unique_fd result{open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW
                                          | O_NONBLOCK | O_CLOEXEC)};
  if (result && fstat(result.get(), &info) == 0 && info.st_uid == *user)
    return result;
  return {};
}

/// Whether a fence has passed for good.
bool has_passed(int folder, const std::string& name, int64_t now_boot_ms) {
  const unique_fd file{openat(folder, name.c_str(),
                              O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
  struct stat info {};
  int64_t moment = 0;
  return file && fstat(file.get(), &info) == 0 && S_ISREG(info.st_mode)
         && pread(file.get(), &moment, sizeof moment, 0) == sizeof moment
         && moment < now_boot_ms - fence_grace_ms;
}

} // namespace

leftovers find_dds_leftovers(const fs::path& folder, const fs::path& proc) {
  leftovers result;
  const auto groups = dds_groups(folder);
  if (groups.empty())
    return result;
  const auto mapped = find_mapped(folder, proc);
  for (const auto& [owner, group] : groups)
    if (is_left(folder, group, mapped))
      for (const auto& name : group)
        add_file(result, folder / name);
  std::sort(result.files.begin(), result.files.end());
  return result;
}

leftovers find_fence_leftovers(const fs::path& folder, int64_t now_boot_ms) {
  leftovers result;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error)) {
    const auto fences = open_fences(i->path());
    if (!fences)
      continue;
    std::error_code closed;
    for (fs::directory_iterator fence{i->path(), closed};
         !closed && fence != end; fence.increment(closed))
      if (const auto name = fence->path().filename().string();
          is_fence_name(name) && has_passed(fences.get(), name, now_boot_ms))
        add_file(result, fence->path());
  }
  std::sort(result.files.begin(), result.files.end());
  return result;
}

finding judge_leftovers(const leftovers& left, const std::string& whose,
                        const std::string& why) {
  if (left.files.empty())
    return {};
  std::string command = "rm -f";
  for (const auto& file : left.files)
    command += " " + shell_word(file.string());
  return {judgement::warning,
          std::to_string(left.files.size()) + " files of " + whose
              + " that nobody uses take "
              + format_bytes(static_cast<double>(left.bytes)),
          why, command};
}

} // namespace roscell::cli
