#include "actors/edge/disk/file_rights.hpp"

#include "actors/edge/disk/small_file.hpp"

#include <linux/posix_acl.h>
#include <linux/posix_acl_xattr.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <system_error>
#include <vector>

namespace roscell {

namespace {

namespace fs = std::filesystem;

/// Users of the host that have no number in this user namespace are shown as
/// this one; its root is among them.
constexpr uid_t nameless_user = 65534;

/// Whether every user of the host has a number here, as outside of containers.
bool sees_all_users() {
  const auto map = read_small_file("/proc/self/uid_map", 4096);
  return !map || map->find("4294967295") != std::string::npos;
}

bool is_own(uid_t user) {
  return user == ::geteuid() || user == 0;
}

bool may_be_own(uid_t user) {
  return is_own(user) || (user == nameless_user && !sees_all_users());
}

std::optional<struct stat> look_at(const fs::path& path, bool follow) {
  struct stat result {};
  const int code =
      follow ? ::stat(path.c_str(), &result) : ::lstat(path.c_str(), &result);
  return code == 0 ? std::optional{result} : std::nullopt;
}

std::string belongs_to(uid_t user) {
  return "belongs to " + user_text(user);
}

std::string quote(const fs::path& path) {
  return "'" + path.string() + "'";
}

/// Of one folder or link on a way.
std::string fault_on_way(const fs::path& path) {
  const auto info = look_at(path, false);
  if (!info)
    return {};
  if (!may_be_own(info->st_uid))
    return quote(path) + " on the way " + belongs_to(info->st_uid);
  if (S_ISDIR(info->st_mode) && (info->st_mode & S_IWOTH) != 0
      && (info->st_mode & S_ISVTX) == 0)
    return "everybody may write into " + quote(path) + " on the way";
  return {};
}

/// The parents of a path, the root first, and what is there itself if it is a
/// link.
std::string fault_on(const fs::path& path) {
  fs::path way;
  for (const auto& part : path.parent_path()) {
    way /= part;
    if (auto fault = fault_on_way(way); !fault.empty())
      return fault;
  }
  const auto last = look_at(path, false);
  return last && S_ISLNK(last->st_mode) ? fault_on_way(path) : std::string{};
}

} // namespace

std::string user_text(uid_t user) {
  std::array<char, 4096> room{};
  struct passwd entry {};
  struct passwd* found = nullptr;
  if (::getpwuid_r(user, &entry, room.data(), room.size(), &found) == 0
      && found != nullptr)
    return "user '" + std::string{found->pw_name} + "'";
  return "user " + std::to_string(user);
}

std::string who_may_change(const fs::path& path) {
  const auto info = look_at(path, true);
  if (!info)
    return {};
  if (!is_own(info->st_uid))
    return "it " + belongs_to(info->st_uid);
  if ((info->st_mode & S_IWOTH) != 0)
    return "everybody may write to it";
  if ((info->st_mode & S_IWGRP) != 0)
    return "its group may write to it";
  return {};
}

std::string who_may_replace(const fs::path& path) {
  std::error_code problem;
  auto given = fs::absolute(path, problem).lexically_normal();
  if (problem)
    return {};
  // "/tmp/n1/" is what "/tmp/n1" is.
  if (!given.has_filename())
    given = given.parent_path();
  if (auto fault = fault_on(given); !fault.empty())
    return fault;
  const auto real = fs::weakly_canonical(given, problem);
  return problem ? std::string{} : fault_on(real);
}

namespace {

constexpr const char* attribute = "system.posix_acl_access";

/// The kernel has its numbers in the order of this machine's only where that is
/// little endian, as all are that this is built for.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__);

using entry_list = std::vector<posix_acl_xattr_entry>;

/// More entries than a file system takes.
constexpr size_t most_entries = 256;

entry_list entries_of_mode(mode_t mode) {
  const auto bits = [mode](int shift) {
    return static_cast<__le16>(mode >> shift & 7);
  };
  constexpr __le32 nobody = ACL_UNDEFINED_ID;
  return {{ACL_USER_OBJ, bits(6), nobody},
          {ACL_GROUP_OBJ, bits(3), nobody},
          {ACL_OTHER, bits(0), nobody}};
}

/// The list, or what the mode says where there is none; empty with errno set.
entry_list entries_of(const std::filesystem::path& file) {
  std::array<char, sizeof(posix_acl_xattr_header)
                       + most_entries * sizeof(posix_acl_xattr_entry)>
      text;
  const auto size =
      ::lgetxattr(file.c_str(), attribute, text.data(), text.size());
  struct stat status {};
  if (size < 0 && errno == ENODATA && ::lstat(file.c_str(), &status) == 0)
    return entries_of_mode(status.st_mode);
  if (size < static_cast<ssize_t>(sizeof(posix_acl_xattr_header)))
    return {};
  const auto bytes = static_cast<size_t>(size) - sizeof(posix_acl_xattr_header);
  entry_list result(bytes / sizeof(posix_acl_xattr_entry));
  std::memcpy(result.data(), text.data() + sizeof(posix_acl_xattr_header),
              result.size() * sizeof(posix_acl_xattr_entry));
  return result;
}

void add_entry(entry_list& to, uid_t user, access_right right) {
  const auto bits = static_cast<__le16>(right);
  const auto known = std::find_if(to.begin(), to.end(), [user](const auto& x) {
    return x.e_tag == ACL_USER && x.e_id == user;
  });
  if (known != to.end())
    known->e_perm |= bits;
  else
    to.push_back({ACL_USER, bits, user});
  // What users of the list and the group may do at most.
  __le16 mask = 0;
  for (const auto& x : to)
    if (x.e_tag == ACL_USER || x.e_tag == ACL_GROUP || x.e_tag == ACL_GROUP_OBJ)
      mask |= x.e_perm;
  const auto found = std::find_if(
      to.begin(), to.end(), [](const auto& x) { return x.e_tag == ACL_MASK; });
  if (found != to.end())
    found->e_perm = mask;
  else
    to.push_back({ACL_MASK, mask, static_cast<__le32>(ACL_UNDEFINED_ID)});
  // The kernel wants them in this order.
  std::sort(to.begin(), to.end(), [](const auto& x, const auto& y) {
    return x.e_tag != y.e_tag ? x.e_tag < y.e_tag : x.e_id < y.e_id;
  });
}

} // namespace

bool let_user(const std::filesystem::path& file, uid_t user,
              access_right right) {
  auto entries = entries_of(file);
  if (entries.empty())
    return false;
  add_entry(entries, user, right);
  const posix_acl_xattr_header header{POSIX_ACL_XATTR_VERSION};
  std::vector<char> text(sizeof(header)
                         + entries.size() * sizeof(posix_acl_xattr_entry));
  std::memcpy(text.data(), &header, sizeof(header));
  std::memcpy(text.data() + sizeof(header), entries.data(),
              entries.size() * sizeof(posix_acl_xattr_entry));
  // A socket and a FIFO have lists like any file, and no link is followed.
  return ::lsetxattr(file.c_str(), attribute, text.data(), text.size(), 0) == 0;
}

bool make_own_folder(const std::filesystem::path& path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST)
    return false;
  struct stat info {};
  if (::lstat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)
      && info.st_uid == ::geteuid() && (info.st_mode & 022) == 0)
    return true;
  errno = EPERM;
  return false;
}

} // namespace roscell
