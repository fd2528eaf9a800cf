#include "actors/edge/host/user_account.hpp"

#include <grp.h>
#include <pwd.h>

#include <array>

namespace roscell {

namespace {

/// More than the line of a user has.
constexpr size_t line_bytes = 16UL * 1024;

/// The kernel takes no more.
constexpr int most_groups = 65'536;

std::vector<gid_t> groups_of(const passwd& user) {
  int count = 64;
  std::vector<gid_t> result(static_cast<size_t>(count));
  while (::getgrouplist(user.pw_name, user.pw_gid, result.data(), &count) < 0) {
    if (count > most_groups)
      return {user.pw_gid};
    result.resize(static_cast<size_t>(count));
  }
  result.resize(static_cast<size_t>(count));
  return result;
}

} // namespace

std::optional<user_account> find_account(const std::string& name) {
  passwd user{};
  passwd* found = nullptr;
  std::array<char, line_bytes> text;
  if (::getpwnam_r(name.c_str(), &user, text.data(), text.size(), &found) != 0
      || found == nullptr)
    return std::nullopt;
  return user_account{user.pw_name, user.pw_uid, user.pw_gid, groups_of(user),
                      user.pw_dir};
}

} // namespace roscell
