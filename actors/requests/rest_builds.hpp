#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/http/http_types.hpp"
#include "messages/failure.hpp"
#include "messages/inside/builds.hpp"
#include "messages/messages.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// What is asked of a build on this node:
///
///     GET  /v1/builds/{hash}?beyond=N        what is here of it
///     GET  /v1/builds/{hash}/manifest
///     GET  /v1/builds/{hash}/pieces/{n}
///     POST /v1/builds/{hash}/manifest?manifest=SHA256&bytes=N
///     POST /v1/builds/{hash}/pieces/{n}
using build_request =
    std::variant<build_query, piece_query, offer_build, store_piece>;

/// What an HTTP request below `builds_path` asks for; a failure if its numbers
/// or hashes are none, nothing if it is no path of these.
std::optional<std::variant<build_request, failure>>
build_route(const http_request& request, const std::vector<std::string>& path);

/// Answers it: with bytes, or with `{"pieces": "1101", "whole": false}`.
void start_build_exchange(caf::actor_system& system,
                          const actor_context& context,
                          const build_keeper_actor& keeper,
                          const build_request& what, const responder& answer);

} // namespace roscell
