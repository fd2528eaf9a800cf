#pragma once

#include "actors/requests/request_context.hpp"

#include <string>

namespace roscell {

/// What a request asks for, as far as it is written down who has.
struct audited_request {
  std::string type; ///< Empty: it changes nothing, or says no type.
  std::string subject;
};

/// Reads that from a request as it has come. What is given to a command that
/// runs is left out: its beginning is there.
audited_request audited_in(const std::string& text);

/// Writes down that somebody has asked for it, and what came of it.
/// @param from as in `route_request`.
/// @param refusal the code of a refusal; empty: it was done.
void note_outcome(const node_services& services, const audited_request& what,
                  const std::string& from, const std::string& refusal);

} // namespace roscell
