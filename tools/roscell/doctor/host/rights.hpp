#pragma once

#include "roscell/node_config.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Who is let in: what proves a node of this host to others, and who decides
/// what it runs.
namespace roscell::cli {

/// Which site token a node has, where it comes from, and what is wrong with it.
findings check_site_token(const checked_host& host);

/// Skills of a node of root that others may change.
findings check_skill_owners(const checked_host& host);

/// Whether a unit of this host makes its node root's, since before nodes had a
/// user of their own.
bool is_kept_root(const std::filesystem::path& units = "/etc/systemd/system");

/// What a node of root should say of itself; empty for others.
std::string root_warning(uid_t user, bool kept);

/// `owner` of the node's state; none where no node has run yet.
finding judge_node_user(std::optional<uid_t> owner, bool kept);

findings check_node_user(const checked_host& host);

/// A folder of skills that others may change.
struct open_skills {
  std::string what;   ///< The folder, and who may.
  std::string remedy; ///< A command.
};

/// Those that a node which runs as root starts. None for a node of another
/// user: there it is his own affair.
std::vector<open_skills> find_open_skills(const node_config& config);

} // namespace roscell::cli
