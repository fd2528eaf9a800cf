#pragma once

#include "tools/roscell/doctor/examined_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

/// Who is let in: what proves a node of this host to others, and who decides
/// what it runs.
namespace roscell::cli {

/// Which site token a node has, where it comes from, and what is wrong with it.
findings examine_site_token(const examined_host& host);

/// Skills of a node of root that others may change.
findings examine_skill_owners(const examined_host& host);

} // namespace roscell::cli
