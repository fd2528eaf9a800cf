#include "actors/edge/disk/access_list.hpp"

#include <linux/posix_acl.h>
#include <linux/posix_acl_xattr.h>
#include <sys/stat.h>
#include <sys/xattr.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

namespace roscell {

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

} // namespace roscell
