#pragma once

#include "client/known_cell.hpp"
#include "messages/codec/json_codec.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// All that is known of one thing, in sections on one screen.
/// @param log the end of an instance's log; of other things nothing.
std::string describe_view(const known_cell& known, const known_thing& what,
                          const std::string& log, const view_style& style);

/// The same for programs: kind, name, what the node tells of it, and events.
json describe_json(const known_cell& known, const known_thing& what,
                   const std::string& log);

/// The last events that concern the thing.
std::vector<event> events_of(const known_cell& known, const known_thing& what);

} // namespace roscell::cli
