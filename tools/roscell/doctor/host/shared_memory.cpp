#include "tools/roscell/doctor/host/shared_memory.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// Fast DDS takes half a MiB for each participant, and an image more.
constexpr uint64_t little_memory = 32ULL << 20;
constexpr uint64_t no_memory = 1ULL << 20;

/// What a container gets that was told nothing.
constexpr uint64_t container_default = 64ULL << 20;

constexpr mode_t open_to_all = 01777;

int try_to_make_a_file(const fs::path& folder) {
  const unique_fd file{
      open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)};
  if (!file)
    return errno == EOPNOTSUPP ? 0 : errno;
  const char byte = 0;
  return pwrite(file.get(), &byte, 1, 0) == 1 ? 0 : errno;
}

} // namespace

shared_memory_readings read_shared_memory(const fs::path& folder) {
  shared_memory_readings result;
  struct stat info {};
  struct statfs kind {};
  struct statvfs room {};
  if (stat(folder.c_str(), &info) != 0 || !S_ISDIR(info.st_mode))
    return result;
  result.exists = true;
  result.all_write = (info.st_mode & 07777) == open_to_all;
  result.in_memory =
      statfs(folder.c_str(), &kind) == 0 && kind.f_type == TMPFS_MAGIC;
  if (statvfs(folder.c_str(), &room) == 0) {
    result.size = static_cast<uint64_t>(room.f_blocks) * room.f_frsize;
    result.free = static_cast<uint64_t>(room.f_bavail) * room.f_frsize;
  }
  result.write_error = try_to_make_a_file(folder);
  return result;
}

finding judge_shared_memory(const fs::path& folder,
                            const shared_memory_readings& memory) {
  const auto at = folder.string();
  const auto word = shell_word(at);
  constexpr auto why =
      "no fence of a movable step can be kept, and stock ROS 2 "
      "programs of this host do not hear each other";
  if (!memory.exists || !memory.in_memory)
    return {memory.exists ? judgement::warning : judgement::broken,
            at + (memory.exists ? " is no memory but a disk" : " is not there"),
            why,
            "sudo mkdir -p " + word
                + " && sudo mount -t tmpfs -o mode=1777 tmpfs " + word};
  const auto room = format_bytes(static_cast<double>(memory.free)) + " of "
                    + format_bytes(static_cast<double>(memory.size))
                    + " are free in " + at;
  if (memory.free < no_memory)
    return {judgement::broken, room, why,
            "sudo mount -o remount,size=" + std::to_string(2 * memory.size)
                + " " + word};
  if (memory.write_error != 0)
    return {judgement::broken,
            "this user cannot write to " + at + ": "
                + std::strerror(memory.write_error),
            why, "sudo mount -o remount,rw,mode=1777 " + word};
  if (!memory.all_write)
    return {judgement::warning, at + " is not open to all users",
            "programs of other users cannot share memory",
            "sudo chmod 1777 " + word};
  if (memory.free < little_memory || memory.size <= container_default)
    return {judgement::warning, room,
            "stock ROS 2 programs need half a MiB each and room for images; a "
            "container gets its host's with --ipc=host",
            "sudo mount -o remount,size=512M " + word};
  return {judgement::ok, room};
}

namespace {

/// Whose folder it is to be; none of another name.
std::optional<uid_t> user_of(const std::string& name) {
  constexpr std::string_view prefix = "roscell-";
  uid_t result = 0;
  const auto* end = name.data() + name.size();
  if (name.compare(0, prefix.size(), prefix) != 0)
    return std::nullopt;
  const auto read = std::from_chars(name.data() + prefix.size(), end, result);
  return read.ec == std::errc{} && read.ptr == end ? std::optional{result}
                                                   : std::nullopt;
}

} // namespace

findings judge_fence_folders(const fs::path& folder) {
  findings result;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error)) {
    const auto user = user_of(i->path().filename().string());
    struct stat info {};
    if (!user || lstat(i->path().c_str(), &info) != 0)
      continue;
    if (S_ISDIR(info.st_mode) && info.st_uid == *user
        && (info.st_mode & (S_IWGRP | S_IWOTH)) == 0)
      continue;
    result.push_back(
        {judgement::broken,
         i->path().string()
             + (info.st_uid == *user
                    ? " is no folder that only its user may "
                      "write to"
                    : " belongs to " + user_word(info.st_uid)
                          + " and should be " + user_word(*user) + "'s"),
         "no step that may move to another node can be started by "
             + user_word(*user),
         "sudo rm -r " + shell_word(i->path().string())});
  }
  return result;
}

findings check_shared_memory(const checked_host& host) {
  const auto folder = fs::path{host.dev} / "shm";
  findings result{judge_shared_memory(folder, read_shared_memory(folder))};
  for (auto& x : judge_fence_folders(folder))
    result.push_back(std::move(x));
  return result;
}

} // namespace roscell::cli
