#pragma once

#include "actors/edge/exec/attached_program.hpp"
#include "actors/edge/exec/exec_channel.hpp"
#include "actors/edge/io/io_core.hpp"

#include <memory>

namespace roscell {

/// The channel of a program on this host. It ends with the process behind
/// `instance` too.
std::shared_ptr<exec_channel>
open_child_channel(std::shared_ptr<io_core> core, attached_program program,
                   bool terminal, unique_fd instance, exec_callbacks calls);

} // namespace roscell
