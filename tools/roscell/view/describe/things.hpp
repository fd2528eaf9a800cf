#pragma once

#include "client/known_cell.hpp"
#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>
#include <vector>

/// INTERNAL to descriptions: what is told of each kind of thing. The thing is
/// known.
namespace roscell::cli {

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
