#pragma once

#include "actors/edge/exec/exec_channel.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/process_spawner.hpp"

#include <sys/types.h>

#include <optional>

namespace roscell {

/// A program that somebody is attached to, and our ends of its streams. None of
/// them blocks.
struct attached_program {
  unique_fd pidfd;
  unique_fd input;    ///< To be written.
  unique_fd output;   ///< To be read.
  unique_fd errors;   ///< The same; none with a terminal.
  unique_fd lifeline; ///< Its other end is the program's descriptor 3.
};

/// Starts it with these streams and no other descriptor of ours, with a
/// terminal of that size or with pipes. Does not wait for what becomes of it.
/// @param user whose its streams are, so that it can open them by their names;
///   none: this user's.
/// Errors: engine_failed.
edge_result<attached_program>
spawn_attached(const program& what, const std::optional<terminal_size>& size,
               std::optional<uid_t> user = std::nullopt);

/// Gives the terminal that `fd` is an end of another size.
void resize_terminal(int fd, terminal_size size);

} // namespace roscell
