#pragma once

#include <filesystem>
#include <map>
#include <string>

/// What a shell needs so that ROS 2 programs started in it are in a cell.
namespace roscell::cli {

using variables = std::map<std::string, std::string>;

/// Lines that bash and zsh evaluate: they set the variables of `environment`,
/// and take away what would mislead Fast DDS. `cell` is said in a comment.
std::string shell_lines(const std::string& cell, const variables& environment);

/// The same for a shell whose programs see all of the cell, as the `ros2`
/// command has to: an ordinary client learns only of what it has use for. Fast
/// DDS before 2.10 is told so by a profile file, `profile`.
std::string super_client_lines(const std::string& cell,
                               const variables& environment,
                               const std::filesystem::path& profile);

/// What is in that file. Throws command_error where ROS_DISCOVERY_SERVER of
/// `environment` is none.
std::string super_client_profile(const variables& environment);

} // namespace roscell::cli
