#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/requests/metrics/exposition.hpp"
#include "actors/requests/request_context.hpp"

#include <memory>

namespace roscell {

/// Answers `GET /metrics`: asks the node or, on a coordinator, the cell for
/// what they know, and writes it down with what was counted. What does not
/// answer in time is left out, or as it was told before. The actor ends with
/// the answer.
void start_scrape(caf::actor_system& system,
                  const std::shared_ptr<const node_services>& services,
                  const responder& answer, exposition_format format);

} // namespace roscell
