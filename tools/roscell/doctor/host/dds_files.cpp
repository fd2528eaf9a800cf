#include "tools/roscell/doctor/host/dds_files.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <system_error>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

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
  // Until version 2 of Fast DDS, and since version 3.
  if (!(begins_with(name, "fastrtps_") || begins_with(name, "fastdds_"))
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

/// Whether somebody holds the lock, or this user cannot know. It is given back
/// at once.
bool may_be_held(const fs::path& lock) {
  const unique_fd file{
      open(lock.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK)};
  return !file || flock(file.get(), LOCK_EX | LOCK_NB) != 0;
}

void add_file(dds_memory& to, const fs::path& file) {
  struct stat info {};
  if (lstat(file.c_str(), &info) != 0 || !S_ISREG(info.st_mode))
    return;
  constexpr uint64_t block = 512;
  if (to.files.empty())
    to.owner = info.st_uid;
  to.bytes += static_cast<uint64_t>(info.st_blocks) * block;
  to.open_to_all = to.open_to_all && (info.st_mode & S_IWOTH) != 0;
  to.files.push_back(file);
}

dds_memory read_memory(const fs::path& folder,
                       const std::vector<std::string>& names) {
  dds_memory result;
  bool has_lock = false, held = false;
  for (const auto& name : names) {
    add_file(result, folder / name);
    has_lock = has_lock || is_lock(name);
    held = held || (is_lock(name) && may_be_held(folder / name));
  }
  result.used = held || !has_lock;
  return result;
}

findings judge_left(const std::vector<dds_memory>& all) {
  size_t count = 0;
  uint64_t bytes = 0;
  std::string command = "rm -f";
  for (const auto& x : all)
    if (!x.used) {
      count += x.files.size();
      bytes += x.bytes;
      for (const auto& file : x.files)
        command += " " + shell_word(file.string());
    }
  if (count == 0)
    return {};
  return {{judgement::warning,
           std::to_string(count) + " files of Fast DDS that nobody uses take "
               + format_bytes(static_cast<double>(bytes)),
           "they take room until the next start of the host, and one of "
           "another user is in the way of a new program",
           command}};
}

findings judge_users(const std::vector<dds_memory>& all) {
  std::set<uid_t> users;
  bool closed = false;
  for (const auto& x : all)
    if (x.used && !x.files.empty()) {
      users.insert(x.owner);
      closed = closed || !x.open_to_all;
    }
  if (!closed || users.size() < 2)
    return {};
  std::vector<std::string> names;
  names.reserve(users.size());
  for (const auto user : users)
    names.push_back(user_word(user));
  return {{judgement::warning,
           "programs of Fast DDS of users " + joined(names, ", ")
               + " have memory that only its user may write to",
           "those of one ROS domain see each other and each other's topics, "
           "and none of the data arrive: begin them as one user",
           "sudo -u " + names.front() + " COMMAND"}};
}

} // namespace

std::vector<dds_memory> find_dds_memory(const fs::path& folder) {
  std::map<std::string, std::vector<std::string>> groups;
  std::error_code error;
  for (fs::directory_iterator i{folder, error}, end; !error && i != end;
       i.increment(error)) {
    const auto name = i->path().filename().string();
    if (const auto owner = dds_owner(name); !owner.empty())
      groups[owner].push_back(name);
  }
  std::vector<dds_memory> result;
  for (auto& [owner, names] : groups) {
    std::sort(names.begin(), names.end());
    result.push_back(read_memory(folder, names));
  }
  return result;
}

findings judge_dds_memory(const std::vector<dds_memory>& all) {
  auto result = judge_left(all);
  for (auto& x : judge_users(all))
    result.push_back(std::move(x));
  if (result.empty())
    result.push_back(
        {judgement::ok, "no memory of Fast DDS is left over, or closed"});
  return result;
}

findings check_leftovers(const checked_host& host) {
  return judge_dds_memory(find_dds_memory(fs::path{host.dev} / "shm"));
}

} // namespace roscell::cli
