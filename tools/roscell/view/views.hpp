#pragma once

#include "messages/cell.hpp"
#include "messages/node.hpp"
#include "messages/skill.hpp"
#include "messages/task.hpp"
#include "tools/roscell/view/table.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// The replies of a node as text for people. `now_unix_ms` is the time that
/// ages are counted to.
namespace roscell::cli {

/// What a view needs to know besides the reply.
struct view_style {
  text_style text;
  int64_t now_unix_ms = 0;
};

/// "coordinator", and "member" for a node that has one.
std::string role_text(node_role role);

std::string node_view(const node_description& node, const view_style& style);

/// The part of a status that only a coordinator can tell.
std::string cell_summary(const cell_description& cell, const view_style& style);

/// The actors of a node with their counters, as a tree of who spawned whom.
std::string actors_view(const std::vector<actor_row>& actors,
                        const view_style& style);

std::string cells_view(const cell_list& cells, const view_style& style);

/// The rows of the registry, and below them the nodes that are in no cell.
std::string members_view(const cell_description& cell, const view_style& style);
std::string tasks_view(const task_description& tasks, const view_style& style);

/// The same, and below it the steps, with how long data are under way.
std::string task_view(const task_description& tasks, const view_style& style);
std::string instances_view(const instance_description& instances,
                           const view_style& style);

/// The same for one, and below it how its earlier runs ended.
std::string instance_view(const instance_description& instances,
                          const view_style& style);
std::string skills_view(const skill_list& skills, const view_style& style);

} // namespace roscell::cli
