#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
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

} // namespace roscell
