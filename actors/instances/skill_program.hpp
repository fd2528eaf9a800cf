#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// The program that a skill folder's descriptor names.
namespace roscell {

/// Where it is, if it is there and can be run. Errors: engine_failed.
edge_result<std::filesystem::path>
find_program(const std::filesystem::path& skill_dir,
             const std::vector<std::string>& entry_point);

/// What a compiled program is for, as container images name it; empty for a
/// script, which runs where its interpreter does, and for unknown machines.
std::string architecture_of_program(const std::filesystem::path& program);

/// Whether a program for `architecture` runs on a host of another one.
bool runs_on(const std::string& architecture, const std::string& host);

/// Of the host that this process runs on.
std::string own_architecture();

} // namespace roscell
