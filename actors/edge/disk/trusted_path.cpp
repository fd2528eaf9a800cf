#include "actors/edge/disk/trusted_path.hpp"

#include "actors/edge/disk/small_file.hpp"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <system_error>

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

} // namespace roscell
