#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>

namespace roscell::cli {

/// Whether a unit of this host makes its node root's, since before nodes had a
/// user of their own.
bool is_kept_root(const std::filesystem::path& units = "/etc/systemd/system");

/// What a node of root should say of itself; empty for others.
std::string root_warning(uid_t user, bool kept);

/// `owner` of the node's state; none where no node has run yet.
finding judge_node_user(std::optional<uid_t> owner, bool kept);

findings check_node_user(const checked_host& host);

} // namespace roscell::cli
