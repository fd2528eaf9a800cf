#pragma once

#include "actors/requests/answer_memory.hpp"
#include "actors/requests/handler_pipeline.hpp"

#include <caf/actor_addr.hpp>
#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// A request that a pipeline works on.
struct running_request {
  std::string id; ///< Its `request_id`, may be empty.
  std::string type;
  std::string subject; ///< The task or node it is about; may be empty.
  request_history::ticket ticket = 0; ///< Its place in the history; 0: none.
  std::chrono::steady_clock::time_point since;
  handler_pipeline_actor worker;
  caf::typed_response_promise<request_routed> promise;
};

/// Owns the registry of requests and who waits for which answer.
struct request_router_state {
  static constexpr const char* name = "request-router";

  std::shared_ptr<const request_registry> registry;
  std::shared_ptr<const node_services> services;
  answer_memory memory;
  /// Who has sent a request again that is still worked on, by its id.
  std::map<std::string,
           std::vector<caf::typed_response_promise<request_routed>>>
      waiting;
  std::map<caf::actor_addr, running_request> running; ///< By pipeline.
  uint64_t routed = 0;
  uint64_t refused = 0;
};

/// The REQUEST ROUTER. Messages: messages/inside/requests.hpp.
request_router_actor::behavior_type request_router(
    request_router_actor::stateful_pointer<request_router_state> self,
    const std::shared_ptr<const request_registry>& registry,
    const std::shared_ptr<const node_services>& services);

} // namespace roscell
