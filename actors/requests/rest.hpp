#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/requests/request_context.hpp"
#include "messages/messages.hpp"
#include "roscell/web_page.hpp"

#include <memory>

namespace roscell {

/// Whom HTTP requests go to.
struct rest_services {
  actor_context context;
  request_router_actor router;
  std::shared_ptr<const node_services> services =
      nullptr; ///< May be null in tests.
  /// For local clients; may be null.
  std::shared_ptr<const web_pages> pages = nullptr;
};

/// Makes the handler that the HTTP server calls on its thread: each request
/// gets an actor of its own, which ends with the answer.
http_handler make_rest_handler(caf::actor_system& system,
                               const rest_services& services);

} // namespace roscell
