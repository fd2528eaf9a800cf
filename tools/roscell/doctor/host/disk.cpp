#include "tools/roscell/doctor/host/disk.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// Below this a node refuses soon, or at once.
constexpr uint64_t little_room = 1ULL << 30;
constexpr uint64_t no_room = 16ULL << 20;
constexpr uint64_t few_files = 1000;

constexpr int fsync_writes = 20;
constexpr std::chrono::seconds fsync_limit{1};

/// A node keeps what it promises before it answers.
constexpr double slow_fsync_ms = 50;

fs::path nearest_folder(fs::path path) {
  std::error_code error;
  while (!fs::exists(path, error) && !error && path.has_relative_path())
    path = path.parent_path();
  return path;
}

/// A file without a name; where the file system has none such, one whose name
/// is gone at once.
unique_fd nameless_file(const fs::path& folder) {
  unique_fd file{open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600)};
  if (file || (errno != EOPNOTSUPP && errno != EISDIR))
    return file;
  auto name = (folder / ".roscell-doctor-XXXXXX").string();
  file = unique_fd{mkostemp(name.data(), O_CLOEXEC)};
  if (file)
    unlink(name.c_str());
  return file;
}

finding may_not_write(const disk_readings& disk) {
  const auto there = shell_word(disk.existing.string());
  const auto seen = "this user cannot write to " + disk.existing.string() + ": "
                    + std::strerror(disk.write_error);
  constexpr auto why = "a node of this user cannot keep who it is and what it "
                       "runs, and does not start";
  if (disk.write_error == EROFS)
    return {judgement::broken, seen, why,
            "sudo mount -o remount,rw \"$(stat -c %m " + there + ")\""};
  // A folder that is there has an owner, who may be meant.
  if (disk.existing == disk.data_dir)
    return {judgement::broken, seen, why, "ls -ld " + there + " && id"};
  return {judgement::broken, seen, why,
          "sudo install -d -m 700 -o " + own_user() + " "
              + shell_word(disk.data_dir.string())};
}

finding judge_room(const disk_readings& disk) {
  const auto room = format_bytes(static_cast<double>(disk.free_bytes));
  const auto at = disk.existing.string();
  const auto look = "du -xhd 1 " + shell_word(at) + " | sort -h";
  if (disk.counts_files && disk.free_files < few_files)
    return {disk.free_files == 0 ? judgement::broken : judgement::warning,
            "there is room for " + std::to_string(disk.free_files)
                + " more files in " + at,
            "tasks and instances are refused when it is used up",
            "df -i " + shell_word(at)};
  const auto seen = room + " are free in " + at;
  if (disk.free_bytes < little_room)
    return {disk.free_bytes < no_room ? judgement::broken : judgement::warning,
            seen, "tasks, instances and images are refused when it is used up",
            look};
  return {judgement::ok, seen};
}

} // namespace

disk_readings read_disk(const fs::path& data_dir) {
  disk_readings result;
  result.data_dir = data_dir;
  result.existing = nearest_folder(data_dir);
  struct statvfs room {};
  if (statvfs(result.existing.c_str(), &room) == 0) {
    result.free_bytes = static_cast<uint64_t>(room.f_bavail) * room.f_frsize;
    result.free_files = room.f_favail;
    result.counts_files = room.f_files != 0;
    if ((room.f_flag & ST_RDONLY) != 0)
      result.write_error = EROFS;
  }
  if (access(result.existing.c_str(), W_OK | X_OK) != 0)
    result.write_error = errno;
  return result;
}

findings judge_disk(const disk_readings& disk) {
  findings result;
  if (disk.write_error != 0)
    result.push_back(may_not_write(disk));
  if (disk.write_error != EACCES)
    result.push_back(judge_room(disk));
  return result;
}

std::optional<std::vector<double>> measure_fsync(const fs::path& folder) {
  using clock = std::chrono::steady_clock;
  const auto file = nameless_file(folder);
  if (!file)
    return std::nullopt;
  constexpr size_t page = 4096;
  std::array<char, page> bytes{};
  std::vector<double> result;
  const auto end = clock::now() + fsync_limit;
  for (int i = 0; i < fsync_writes && clock::now() < end; ++i) {
    const auto begin = clock::now();
    const auto at = static_cast<off_t>(page) * i;
    if (pwrite(file.get(), bytes.data(), page, at) != static_cast<ssize_t>(page)
        || fsync(file.get()) != 0)
      return std::nullopt;
    const std::chrono::duration<double, std::milli> took = clock::now() - begin;
    result.push_back(took.count());
  }
  return result;
}

finding judge_fsync(const fs::path& folder, std::vector<double> took_ms) {
  const auto middle =
      took_ms.begin() + static_cast<std::ptrdiff_t>(took_ms.size() / 2);
  std::nth_element(took_ms.begin(), middle, took_ms.end());
  const auto median = *middle;
  const auto seen = "4 KiB are kept in " + format_significant(median, 2)
                    + " ms (median of " + std::to_string(took_ms.size()) + ")";
  if (median < slow_fsync_ms)
    return {judgement::ok, seen};
  return {judgement::warning, seen,
          "each change of a task is kept before it is answered for: requests "
          "take several times as long. A node that is to keep who it is takes "
          "its data directory along to a faster disk",
          "findmnt -T " + shell_word(folder.string())};
}

findings check_disk(const checked_host& host) {
  return judge_disk(read_disk(host.config.data_dir));
}

findings check_fsync(const checked_host& host) {
  const auto folder = read_disk(host.config.data_dir).existing;
  const auto took = measure_fsync(folder);
  if (!took || took->empty())
    return {
        {judgement::skipped, "nothing can be written to " + folder.string()}};
  return {judge_fsync(folder, *took)};
}

} // namespace roscell::cli
