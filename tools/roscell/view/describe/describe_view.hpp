#pragma once

#include "client/known_cell.hpp"
#include "messages/codec/json_codec.hpp"
#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

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

// INTERNAL to descriptions: what is told of each kind of thing. The thing is
// known.

void describe_node(page& out, const known_cell& known, const std::string& name,
                   const view_style& style);
void describe_task(page& out, const known_cell& known, const std::string& name,
                   const view_style& style);
void describe_instance(page& out, const known_cell& known,
                       const std::string& name, const view_style& style);
void describe_skill(page& out, const known_cell& known, const std::string& name,
                    const view_style& style);
void describe_cell(page& out, const known_cell& known, const view_style& style);

/// The builds that do an operation.
std::vector<skill_row> builds_of(const known_cell& known,
                                 const std::string& operation);

/// What the node tells of the thing, as a message has it.
json json_of(const known_cell& known, const known_thing& what);

/// Text of several lines, each safe for a terminal.
std::string printable_lines(const std::string& text);

} // namespace roscell::cli
