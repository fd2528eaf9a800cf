#pragma once

#include "actors/edge/engine/engine_client.hpp"

#include <string>

namespace roscell {

/// What a reply that is not good says, in the engine's own words: Docker's
/// `message`, Podman's `message` and `cause`. Code: engine_failed.
edge_error engine_refusal(const std::string& what, const engine_reply& reply);

/// Why a socket cannot be connected to, with the remedy.
edge_error no_engine(const std::string& socket, int error_number);

/// How a person sees what the engine behind a socket has logged.
std::string engine_log_command(const std::string& socket);

} // namespace roscell
