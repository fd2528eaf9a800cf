#pragma once

#include "test/site/site.hpp"

#include <string>
#include <vector>

/// What a coordinator of a site believes of tasks. The only place of the site's
/// tests that looks into its tables of tasks.
namespace roscell::test {

struct step_view {
  std::string step;
  std::string instance;
  std::string node;
  bool ended = false;        ///< The coordinator knows that it has ended.
  bool starts_again = false; ///< Its node is starting it again.
};

struct task_view {
  std::string task;
  task_state state = task_state::deploying;
  std::vector<step_view> steps;
};

/// Of a coordinator that lives.
std::vector<task_view> tasks_of(const site_party& coordinator);

/// Instances that its registry shows, with the node that shows them.
size_t instances_shown(const site_party& coordinator);

/// Whether the coordinator shows the node as its active member, and the node
/// believes so; a coordination node is its own member.
bool are_cell(const site_party& coordinator, const site_party& node);

site_party* find_party(const site& place, const std::string& name);

} // namespace roscell::test
