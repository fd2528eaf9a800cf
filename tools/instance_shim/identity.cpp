#include "tools/instance_shim/identity.hpp"

#include <grp.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

namespace roscell::shim {

namespace {

/// Sets of this version have two words of 32 bits.
constexpr auto words = _LINUX_CAPABILITY_U32S_3;
constexpr int word_bits = 32;

/// Those after the last one that the kernel knows are refused.
constexpr int most_capabilities = 64;

bool bit_of(std::uint64_t set, int number) {
  return (set >> number & 1) != 0;
}

/// Reads a number up to `end`, and goes behind that.
bool take_number(const char*& at, char end, id_t& result) {
  char* behind = nullptr;
  errno = 0;
  const auto value = std::strtoul(at, &behind, 10);
  // The highest one means "no change" to the kernel.
  if (*at < '0' || *at > '9' || errno != 0 || value >= 0xFFFFFFFF
      || (*behind != end && *behind != '\0'))
    return false;
  result = static_cast<id_t>(value);
  at = *behind == '\0' ? behind : behind + 1;
  return true;
}

std::uint64_t permitted() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[words] = {};
  if (::syscall(SYS_capget, &header, data) != 0)
    return 0;
  return data[0].permitted | std::uint64_t{data[1].permitted} << word_bits;
}

bool set_capabilities(std::uint64_t set) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[words] = {};
  for (auto i = 0; i < words; ++i) {
    const auto word = static_cast<std::uint32_t>(set >> (i * word_bits));
    data[i] = {word, word, word};
  }
  return ::syscall(SYS_capset, &header, data) == 0;
}

/// Whoever is root gets what is in this set by running a program. Who may not
/// make it smaller cannot become root either.
void bound_capabilities(std::uint64_t set) {
  for (auto i = 0; i < most_capabilities; ++i)
    if (!bit_of(set, i) && ::prctl(PR_CAPBSET_DROP, i) != 0 && errno == EINVAL)
      return;
}

bool become_user(const identity& wanted) {
  return ::prctl(PR_SET_KEEPCAPS, 1) == 0
         && ::setgroups(wanted.group_count, wanted.groups) == 0
         && ::setresgid(wanted.group, wanted.group, wanted.group) == 0
         && ::setresuid(wanted.user, wanted.user, wanted.user) == 0;
}

/// Who is not root would lose its capabilities by running a program.
void hand_on(std::uint64_t set) {
  ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_CLEAR_ALL, 0, 0, 0);
  for (auto i = 0; i < most_capabilities; ++i)
    if (bit_of(set, i))
      ::prctl(PR_CAP_AMBIENT, PR_CAP_AMBIENT_RAISE, i, 0, 0);
}

} // namespace

bool read_user(const char* text, identity& result) {
  id_t user = 0;
  id_t group = 0;
  if (!take_number(text, ':', user) || !take_number(text, ',', group))
    return false;
  result.user = user;
  result.group = group;
  while (*text != '\0') {
    if (result.group_count == identity::most_groups
        || !take_number(text, ',', group))
      return false;
    result.groups[result.group_count++] = group;
  }
  return result.has_user = true;
}

bool read_capabilities(const char* text, identity& result) {
  char* end = nullptr;
  errno = 0;
  result.capabilities = std::strtoull(text, &end, 16);
  return result.has_capabilities = end != text && *end == '\0' && errno == 0;
}

bool take_identity(const identity& wanted) {
  const auto kept =
      wanted.has_capabilities ? wanted.capabilities & permitted() : permitted();
  if (wanted.has_capabilities)
    bound_capabilities(kept);
  if (wanted.has_user && !become_user(wanted))
    return false;
  if (!wanted.has_capabilities)
    return true;
  if (!set_capabilities(kept))
    return false;
  hand_on(kept);
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0;
}

} // namespace roscell::shim
