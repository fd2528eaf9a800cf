#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

/// Who is let in: what proves a node of this host to others, and who decides
/// what it runs.
namespace roscell::cli {

/// Which site token a node has, where it comes from, and what is wrong with it.
findings check_site_token(const checked_host& host);

/// Skills of a node of root that others may change.
findings check_skill_owners(const checked_host& host);

} // namespace roscell::cli
