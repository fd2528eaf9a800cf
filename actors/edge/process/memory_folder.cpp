#include "actors/edge/process/memory_folder.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/privileges.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/stat.h>
#include <sys/statfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace roscell {

namespace {

namespace fs = std::filesystem;

edge_error no_memory_file(const std::string& what, const fs::path& path) {
  return {error_code::internal,
          "cannot " + what + " '" + path.string()
              + "': " + std::strerror(errno),
          "secrets are given in files of memory: `df /run /dev/shm` shows what "
          "room there is"};
}

/// What others may make beside it, or put in its place, is not touched.
bool is_own_folder(const fs::path& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)
         && info.st_uid == ::geteuid() && (info.st_mode & 022) == 0;
}

/// The first place that lies in memory and that this user may write to; empty:
/// there is none.
fs::path first_usable(const std::vector<fs::path>& places) {
  for (const auto& x : places)
    if (is_in_memory(x) && ::access(x.c_str(), W_OK | X_OK) == 0)
      return x;
  return {};
}

/// Whom the files are for. None: this process's own user.
edge_result<std::optional<user_account>> reader_of(const std::string& user) {
  if (user.empty())
    return std::optional<user_account>{};
  auto account = find_account(user);
  if (!account)
    return edge_error{error_code::internal,
                      "there is no user '" + user + "' any more",
                      "the node's configuration grants it: `grant`"};
  return account->user == ::geteuid() ? std::optional<user_account>{}
                                      : std::move(account);
}

/// Root gives it away; others may only let somebody in.
bool hand_over(const fs::path& path, const std::optional<user_account>& to,
               access_right right) {
  if (!to)
    return true;
  return ::geteuid() == 0 ? ::lchown(path.c_str(), to->user, to->group) == 0
                          : let_user(path, to->user, right);
}

/// A file that nobody has made before, with this in it.
bool make_file(const fs::path& path, const std::string& bytes) {
  const unique_fd file{
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
             S_IRUSR)};
  return file && write_whole(file.get(), bytes);
}

/// The folder goes last: until then nobody else can put anything into it.
std::optional<edge_error> fill(const fs::path& folder,
                               const memory_folder::file_list& files,
                               const std::optional<user_account>& reader) {
  if (::mkdir(folder.c_str(), 0700) != 0)
    return no_memory_file("make the folder", folder);
  for (const auto& [name, bytes] : files)
    if (!make_file(folder / name, bytes)
        || !hand_over(folder / name, reader, access_right::read))
      return no_memory_file("lay a secret out in", folder / name);
  if (!hand_over(folder, reader, access_right::pass))
    return no_memory_file("hand over", folder);
  return std::nullopt;
}

} // namespace

std::vector<fs::path> memory_places() {
  std::vector<fs::path> result;
  if (::geteuid() == 0)
    result.emplace_back("/run");
  else
    for (const auto* name : {"RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR"})
      if (const char* own = std::getenv(name); own != nullptr && own[0] == '/')
        result.emplace_back(own);
  result.emplace_back("/dev/shm");
  return result;
}

bool is_in_memory(const fs::path& path) {
  struct statfs info {};
  return ::statfs(path.c_str(), &info) == 0
         && (info.f_type == TMPFS_MAGIC || info.f_type == RAMFS_MAGIC);
}

memory_folder::memory_folder(std::vector<fs::path> places, std::string name)
    : places_{std::move(places)}, name_{std::move(name)} {}

edge_result<fs::path> memory_folder::lay_out(const std::string& program,
                                             const file_list& files,
                                             const std::string& user) const {
  const auto place = first_usable(places_);
  if (place.empty())
    return edge_error{error_code::internal,
                      "there is no file system of memory to lay secrets out in",
                      "mount a tmpfs at /run or /dev/shm that this user may "
                      "write to"};
  const auto reader = reader_of(user);
  if (const auto* why = std::get_if<edge_error>(&reader))
    return *why;
  const auto own = place / name_;
  // Others may pass, for their own folders; they see none of them.
  if (!make_own_folder(own) || ::chmod(own.c_str(), 0711) != 0)
    return no_memory_file("keep for itself the folder", own);
  clear(program);
  auto folder = own / program;
  if (auto why =
          fill(folder, files, std::get<std::optional<user_account>>(reader))) {
    clear(program);
    return std::move(*why);
  }
  return folder;
}

void memory_folder::clear(const std::string& program) const {
  std::error_code ignored;
  for (const auto& place : places_)
    if (is_own_folder(place / name_))
      fs::remove_all(place / name_ / program, ignored);
}

void memory_folder::clear_others(const std::set<std::string>& programs) const {
  for (const auto& place : places_) {
    if (!is_own_folder(place / name_))
      continue;
    std::vector<std::string> left;
    std::error_code problem;
    for (fs::directory_iterator i{place / name_, problem}, end;
         !problem && i != end; i.increment(problem))
      if (auto name = i->path().filename().string(); programs.count(name) == 0)
        left.push_back(std::move(name));
    for (const auto& x : left)
      clear(x);
  }
}

} // namespace roscell
