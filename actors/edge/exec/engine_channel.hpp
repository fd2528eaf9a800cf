#pragma once

#include "actors/edge/exec/exec_channel.hpp"
#include "actors/edge/exec/lifeline_socket.hpp"
#include "actors/edge/io/io_core.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// How a command is run in a container.
struct engine_command {
  std::string socket; ///< The engine's.
  std::string api;    ///< Version of Docker's API; empty: the engine's own.
  exec_order order;
  /// All words of it, made of those that the container was started with.
  std::function<std::vector<std::string>(const std::vector<std::string>&)>
      words;
  std::vector<std::string> environment; ///< "NAME=value", besides its own.
  lifeline_socket lifeline;             ///< The command ends when this is cut.
};

/// The channel of a command that an engine runs in a container, by its API for
/// that: a stream of the engine's socket.
std::shared_ptr<exec_channel> open_engine_channel(std::shared_ptr<io_core> core,
                                                  engine_command what,
                                                  exec_callbacks calls);

} // namespace roscell
