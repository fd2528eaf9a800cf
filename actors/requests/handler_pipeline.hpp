#pragma once

#include "actors/requests/request_registry.hpp"

namespace roscell {

/// Carries one request, a document that has passed its schema, through its
/// handlers and ends with it, so that whatever kills it fails that request
/// only: the next one gets a new actor. `ticket` is the request's in the
/// node's history, which the handlers go on to write. Messages:
/// messages/inside/requests.hpp.
handler_pipeline_actor::behavior_type
handler_pipeline(pipeline_pointer self, const request_runner& run,
                 const std::shared_ptr<const node_services>& services,
                 const std::shared_ptr<const json>& document,
                 request_history::ticket ticket);

} // namespace roscell
