#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/skill.hpp"

#include <filesystem>
#include <string>

/// What skill a build is, whatever architecture it is for. Both block on the
/// disk.
namespace roscell {

/// Errors: schema_violation (it is no skill that could run anywhere).
edge_result<installed_skill> read_skill(const std::filesystem::path& folder,
                                        const std::string& architecture);

/// Whether it can run on a host of that architecture.
bool is_skill_of(const std::filesystem::path& folder,
                 const std::string& architecture);

} // namespace roscell
