#pragma once

#include <functional>
#include <string>

namespace roscell {

/// Makes this process fit for our DDS participants. To be called once, by the
/// program's `main`, before it starts a thread and before any participant is
/// made, because it changes the process's environment and Fast DDS's log:
///
/// - `ROS_DISCOVERY_SERVER`, `FASTDDS_ENVIRONMENT_FILE` and
///   `FASTRTPS_DEFAULT_PROFILES_FILE` are unset: the first would turn simple
///   participants into clients and make our servers join a foreign one, the
///   others can bring it back or alter every default. Children that need them
///   must be given them.
/// - `SKIP_DEFAULT_XML=1` is set, so that no file in the working directory
///   counts. Children inherit it unless the caller leaves it out for them.
/// - Fast DDS prints nothing. What it would have printed, errors only, goes to
///   `on_error` from a thread of its own, if one is given.
///
/// A program that embeds a node calls this or does the equivalent itself; the
/// classes of this folder do not.
void prepare_dds_environment(
    std::function<void(const std::string&)> on_error = {});

} // namespace roscell
