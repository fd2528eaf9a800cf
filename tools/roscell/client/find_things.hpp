#pragma once

#include "client/known_cell.hpp"
#include "messages/kept_log.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What somebody means by a word.
namespace roscell::cli {

/// The thing of that name, or the only instance whose id begins so. Throws
/// command_error that says what was probably meant, or which kinds have the
/// name.
/// @param kind the word of a kind; empty: any.
known_thing find_thing(const known_cell& known, const std::string& kind,
                       const std::string& name);

/// The instances that `word` means: the one of that id, else all of the task of
/// that name, else the only one whose id begins so. Throws command_error that
/// names what was probably meant, or which ones begin so.
std::vector<instance_row> find_instances(const std::vector<instance_row>& known,
                                         const std::string& word);

/// The kept logs that `word` means: the newest of the instance of that id, else
/// of the task of that name the newest of each step, else the newest of the
/// only instance whose id begins so. None if there is none of these. Throws
/// command_error that names which ones begin so.
/// @param known with the newest first.
std::vector<kept_log> find_kept_logs(const std::vector<kept_log>& known,
                                     const std::string& word);

/// "i on node belt: stopped 5m02s ago (removed)".
std::string kept_log_text(const kept_log& log, int64_t now_unix_ms);

known_cell ask_for_cell(const node_client& node);

/// Adds what the coordinator knows of its cell to what a member has said. False
/// if there is no more to know: the node is the coordinator itself, or is in no
/// cell.
bool add_cell_of_member(const node_client& node, known_cell& known);

/// The instances of all tasks of the cell, as its coordinator knows them; none
/// if it cannot be asked.
std::vector<instance_row> instances_in_cell(const node_client& node);

} // namespace roscell::cli
