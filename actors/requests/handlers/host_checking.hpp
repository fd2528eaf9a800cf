#pragma once

#include "actors/requests/request_context.hpp"

namespace roscell {

/// Has the program look at its host, by a thread of its own. `conflict` where
/// the program cannot, or is looking already.
void check_host(const request_context& context, examination_query query,
                outcome<examination> done);

/// Looks, unless that is being done already: then there is nothing.
std::function<findings()> one_at_a_time(std::function<findings()> look);

} // namespace roscell
