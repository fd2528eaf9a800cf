#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/house/house.hpp"
#include "messages/messages.hpp"

#include <memory>

namespace roscell {

/// Whom HTTP requests go to.
struct rest_services {
  house context;
  request_router_actor router;
};

/// Makes the handler that the HTTP server calls on its thread: each request
/// gets an actor of its own, which ends with the answer.
http_handler make_rest_handler(caf::actor_system& system,
                               const rest_services& services);

} // namespace roscell
