#pragma once

#include "messages/event.hpp"
#include "messages/node.hpp"

#include <cstdint>
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

/// Where events are wanted from.
struct event_start {
  uint64_t number = 0; ///< Those after it,
  int64_t unix_ms = 0; ///< from the first one on that is not older; 0: all.
  bool on_disk = true; ///< Also those that are not in memory any more.
};

/// From what people write: a number, where 0 means what is in memory; `start`,
/// a span such as `2h` or `7d`, a moment such as `2026-11-25`, `2026-11-25
/// 08:00`, `2026-11-25T08:00:30Z`, or `08:00`, the last one that was. Without Z
/// a moment is by this host's clock. Throws std::invalid_argument that says
/// what can be written.
event_start parse_event_start(const std::string& text, int64_t now_unix_ms);

} // namespace roscell::cli
