#pragma once

#include "actors/instances/exec/exec_host.hpp"

#include "actors/edge/io/io_core.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace roscell {

/// Begins commands in containers.
/// @param socket the engine's.
/// @param api version of Docker's API; empty: the engine's own.
/// @param data_dir where the runtime has the sockets of its containers.
exec_opener engine_opener(std::shared_ptr<io_core> core, std::string socket,
                          std::string api, std::filesystem::path data_dir);

} // namespace roscell
