#pragma once

#include "client/event_stream.hpp"
#include "messages/node.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// One line for people: time, number, event, subject and the particulars. Of an
/// instance the subject is its task. No line end.
/// @param width columns of the terminal; where it is narrow the date is left
///   out. 0: no bound.
std::string event_line(const event& e, size_t width = 0);

/// Headings above such lines.
std::string event_heading(size_t width = 0);

/// The particulars of an event as "key=value", one blank between them.
std::string event_particulars(const event& e);

/// The text at `key` in an event's particulars; empty if there is none.
std::string event_text(const event& e, const char* key);

/// Whether people do without it: an instance is only on its way to something,
/// or it is what a coordinator's own node says of one without saying where,
/// which the coordinator then says again for the cell.
bool is_on_the_way(const event& e, node_role asked);

/// What an event means to somebody who waits for `task`, in lines such as
/// "step poses: starting on arm-1". None if it does not concern the task.
std::vector<std::string> progress_lines(const event& e,
                                        const std::string& task);

/// What an event means to somebody who waits for nodes to move, in lines such
/// as "arm-1: node joined". None if its subject is no such node.
std::vector<std::string> movement_lines(const event& e,
                                        const std::vector<std::string>& nodes);

} // namespace roscell::cli
