#pragma once

#include "messages/inside/introspection.hpp"

#include <caf/actor_system.hpp>

#include <string>

namespace roscell::cli {

/// Writes the events of a node to the log of this process, for people who read
/// it or the service manager's journal: what concerns the cell in sentences,
/// losses and failures as warnings. Ends with `events`.
void start_journal(caf::actor_system& system, const event_log_actor& events);

/// An event in one line: "joined cell 'lab' of 'arm-1'".
std::string journal_line(const event& e);

} // namespace roscell::cli
