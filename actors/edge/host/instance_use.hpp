#pragma once

#include "messages/inside/agent.hpp"

#include <string>
#include <vector>

namespace roscell {

/// What each of these instances takes of the host: from its cgroup where it has
/// one of its own, else from its processes. Of containers whose engine makes
/// none nothing is known. Instances of which nothing is known are left out.
/// @param root where /proc is, for tests.
std::vector<measured_use>
uses_of(const std::vector<measured_instance>& instances,
        const std::string& root = {});

} // namespace roscell
