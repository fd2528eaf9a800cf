#pragma once

#include "messages/instance.hpp"
#include "messages/skill_descriptor.hpp"

#include <chrono>
#include <map>
#include <string>

namespace roscell {

/// What an instance is told by its environment: the contract of
/// skills/engine/environment.hpp, without NOTIFY_SOCKET, which is the
/// runtime's. The deployment option's own variables come first, the spec's
/// replace them, then the node's, then the contract's.
std::map<std::string, std::string>
instance_environment(const instance_spec& spec,
                     const deployment_option& deployment,
                     const std::map<std::string, std::string>& of_node = {});

} // namespace roscell
