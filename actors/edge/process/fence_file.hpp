#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>

/// The files by which the shims of instances are told how long these may go on
/// (tools/instance_shim/supervision.hpp): one 64-bit number each, in
/// milliseconds of CLOCK_BOOTTIME.
namespace roscell {

/// Where the fence of an instance lies: in memory, for it is written every few
/// seconds, and a fence of an earlier boot has no meaning. The name is derived
/// from the instance's folder, so that a node that was restarted finds it.
std::filesystem::path fence_path(const std::filesystem::path& instance_dir);

/// Makes the file, in place of an older one. Errors: engine_failed.
std::optional<edge_error> make_fence(const std::filesystem::path& path,
                                     int64_t boot_ms);

/// Moves a fence on, but never back. A file that is not there is not made: who
/// reads it may know another one by that name. Errors: engine_failed.
std::optional<edge_error> move_fence(const std::filesystem::path& path,
                                     int64_t boot_ms);

/// Removes the file, if there is one.
void remove_fence(const std::filesystem::path& path);

} // namespace roscell
