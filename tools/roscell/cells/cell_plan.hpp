#pragma once

#include "messages/cell.hpp"
#include "messages/skill.hpp"
#include "tools/roscell/cells/cell_document.hpp"
#include "tools/roscell/tasks/task_apply.hpp"
#include "tools/roscell/view/table.hpp"

#include <optional>
#include <string>
#include <vector>

/// What a cell lacks of what a document says, and has besides.
namespace roscell::cli {

struct cell_options : apply_options {
  std::string file;
  file_values values;
  bool prune = false;      ///< What is in no document goes.
  bool take_nodes = false; ///< Also nodes that are in other cells.
};

/// A cell as its coordinator tells it.
struct present_cell {
  cell_description cell;
  skill_list skills;
  std::vector<task_set_row> sets;
};

present_cell look_at_cell(const node_client& node);

/// A task of the document, and what is to be done with it; none: it cannot be
/// said before nodes or skills are there.
struct planned_task {
  task_file file;
  std::optional<task_plan_shown> shown;
};

struct cell_plan {
  std::vector<std::string> joining; ///< Nodes.
  std::vector<wanted_skill> added;
  std::vector<planned_task> tasks; ///< All of the document, in its order.
  // What goes, where that is wanted.
  std::vector<std::string> ended; ///< Tasks.
  std::vector<wanted_skill> removed;
  std::vector<std::string> leaving; ///< Nodes.

  bool differs() const;
};

/// Compares; nothing is changed. Throws wrong_document for a cell of another
/// name, a node that cannot come, and a skill that is nowhere; and as
/// `plan_apply` does.
cell_plan plan_cell(const cell_options& options, const node_client& node,
                    const cell_document& wanted);

/// Does it, and says what has been done. Throws as above, and command_error for
/// a node that does not come.
void make_cell(const cell_options& options, const node_client& node,
               const cell_plan& plan);

/// What differs, for people and for programs.
std::string cell_plan_view(const cell_plan& plan, const text_style& style);
json cell_plan_json(const cell_plan& plan);

} // namespace roscell::cli
