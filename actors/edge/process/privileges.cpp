#include "actors/edge/process/privileges.hpp"

#include <grp.h>
#include <linux/capability.h>
#include <pwd.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <iterator>

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

namespace {

/// Each at the place of its number.
constexpr std::string_view capability_names[] = {"CHOWN",
                                                 "DAC_OVERRIDE",
                                                 "DAC_READ_SEARCH",
                                                 "FOWNER",
                                                 "FSETID",
                                                 "KILL",
                                                 "SETGID",
                                                 "SETUID",
                                                 "SETPCAP",
                                                 "LINUX_IMMUTABLE",
                                                 "NET_BIND_SERVICE",
                                                 "NET_BROADCAST",
                                                 "NET_ADMIN",
                                                 "NET_RAW",
                                                 "IPC_LOCK",
                                                 "IPC_OWNER",
                                                 "SYS_MODULE",
                                                 "SYS_RAWIO",
                                                 "SYS_CHROOT",
                                                 "SYS_PTRACE",
                                                 "SYS_PACCT",
                                                 "SYS_ADMIN",
                                                 "SYS_BOOT",
                                                 "SYS_NICE",
                                                 "SYS_RESOURCE",
                                                 "SYS_TIME",
                                                 "SYS_TTY_CONFIG",
                                                 "MKNOD",
                                                 "LEASE",
                                                 "AUDIT_WRITE",
                                                 "AUDIT_CONTROL",
                                                 "SETFCAP",
                                                 "MAC_OVERRIDE",
                                                 "MAC_ADMIN",
                                                 "SYSLOG",
                                                 "WAKE_ALARM",
                                                 "BLOCK_SUSPEND",
                                                 "AUDIT_READ",
                                                 "PERFMON",
                                                 "BPF",
                                                 "CHECKPOINT_RESTORE"};

} // namespace

std::optional<int> capability_number(std::string_view name) {
  const auto* found =
      std::find(std::begin(capability_names), std::end(capability_names), name);
  if (found == std::end(capability_names))
    return std::nullopt;
  return static_cast<int>(found - std::begin(capability_names));
}

capability_set to_capabilities(const std::vector<std::string>& names) {
  capability_set result = 0;
  for (const auto& x : names)
    if (const auto number = capability_number(x))
      result |= capability_set{1} << *number;
  return result;
}

bool has_capability(capability_set all, std::string_view name) {
  const auto number = capability_number(name);
  return number && (all >> *number & 1) != 0;
}

capability_set own_capabilities() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (::syscall(SYS_capget, &header, data.data()) != 0)
    return 0;
  return data[0].permitted | capability_set{data[1].permitted} << 32;
}

capability_set file_capabilities() {
  return to_capabilities(
      {"CHOWN", "DAC_OVERRIDE", "DAC_READ_SEARCH", "FOWNER", "FSETID"});
}

} // namespace roscell
