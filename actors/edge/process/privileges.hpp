#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// A user of this host, as a program of his has it.
struct user_account {
  std::string name;
  uid_t user = 0;
  gid_t group = 0;
  std::vector<gid_t> groups; ///< All that he is in, `group` among them.
  std::string home;
};

/// None if there is no such user. Blocks on the host's lists of users, which
/// may be on another host.
std::optional<user_account> find_account(const std::string& name);

// Linux capabilities: the parts that root's power is made of.

/// As bits of one number, by the kernel's numbers.
using capability_set = uint64_t;

/// By a name like "NET_RAW"; none for one that is unknown.
std::optional<int> capability_number(std::string_view name);

/// Unknown names count for nothing.
capability_set to_capabilities(const std::vector<std::string>& names);

bool has_capability(capability_set all, std::string_view name);

/// What this process may use.
capability_set own_capabilities();

/// What a program of root's keeps without being granted anything: its way
/// around permissions of files, without which it could do less than anybody.
capability_set file_capabilities();

} // namespace roscell
