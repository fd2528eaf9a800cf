#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/inside/runtime.hpp"

#include <string>
#include <vector>

/// What a container may, and who runs in it: nothing of root's power but what
/// its skill is granted, and nothing more by whatever it runs.
namespace roscell {

/// Writes that into the document's HostConfig.
void bound_powers(json& host, const start_container& request, bool rootless);

/// The user of its first process, the shim: the node's, inside as outside, for
/// files and shared memory belong to him; root of a rootless engine is him. An
/// engine gives capabilities to root alone, so that a shim which hands some on
/// is root, and makes the skill what it is.
std::string container_user(const start_container& request, bool rootless);

/// What tells the shim who the skill is to be.
std::vector<std::string> identity_options(const start_container& request,
                                          bool rootless);

} // namespace roscell
