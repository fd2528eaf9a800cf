#include "tools/roscell/doctor/host/inotify.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

/// Each skill that follows a file has one, and a node one for each log that is
/// followed.
constexpr int64_t wanted_instances = 32;
constexpr int64_t advised_instances = 1024;

bool is_process_of(const fs::path& folder, uid_t user) {
  const auto name = folder.filename().string();
  struct stat info {};
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; })
         && ::stat(folder.c_str(), &info) == 0 && info.st_uid == user;
}

int64_t instances_in(const fs::path& process) {
  int64_t result = 0;
  std::error_code error;
  for (fs::directory_iterator i{process / "fd", error}, end; !error && i != end;
       i.increment(error)) {
    std::error_code gone;
    if (fs::read_symlink(i->path(), gone) == "anon_inode:inotify")
      ++result;
  }
  return result;
}

} // namespace

inotify_readings read_inotify(const std::string& proc, uid_t user) {
  inotify_readings result;
  const fs::path root{proc};
  std::ifstream file{root / "sys/fs/inotify/max_user_instances"};
  if (!(file >> result.most))
    result.most = -1;
  std::error_code error;
  for (fs::directory_iterator i{root, error}, end; !error && i != end;
       i.increment(error))
    if (is_process_of(i->path(), user))
      result.used += instances_in(i->path());
  return result;
}

finding judge_inotify(const inotify_readings& seen) {
  if (seen.most < 0)
    return {judgement::skipped, "the kernel does not report inotify"};
  const auto words = std::to_string(seen.used) + " of "
                     + std::to_string(seen.most)
                     + " inotify instances of this user are in use";
  if (seen.most - seen.used >= wanted_instances)
    return {judgement::ok, words};
  return {
      judgement::warning, words,
      "each skill that follows a file, and each log that is followed, takes "
      "one: without it a skill looks once a second, and lines of a log come "
      "late",
      "sudo sysctl -w fs.inotify.max_user_instances="
          + std::to_string(std::max(advised_instances, 2 * seen.most))};
}

findings check_inotify(const checked_host& host) {
  return {judge_inotify(read_inotify(host.proc, ::geteuid()))};
}

} // namespace roscell::cli
