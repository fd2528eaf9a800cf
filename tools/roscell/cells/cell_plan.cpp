#include "tools/roscell/cells/cell_plan.hpp"

#include "actors/builds/limits.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/update_view.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

[[noreturn]] void refuse(const cell_document& wanted, error_code code,
                         const std::string& what, const std::string& where,
                         const std::string& hint) {
  throw wrong_document{wanted.file, {code, what, where, hint}};
}

bool is_member(const cell_description& cell, const std::string& node) {
  return std::any_of(cell.nodes.begin(), cell.nodes.end(),
                     [&](const auto& x) { return x.identity.name == node; });
}

bool is_unassigned(const cell_description& cell, const std::string& node) {
  return std::any_of(cell.free.begin(), cell.free.end(), [&](const auto& x) {
    return x.name == node && x.silent_since_unix_ms == 0;
  });
}

void plan_nodes(const cell_options& options, const present_cell& known,
                const cell_document& wanted, cell_plan& plan) {
  for (size_t i = 0; i < wanted.nodes.size(); ++i) {
    const auto& name = wanted.nodes[i];
    if (is_member(known.cell, name))
      continue;
    if (!options.take_nodes && !is_unassigned(known.cell, name))
      refuse(
          wanted, error_code::unknown_node,
          "node '" + name
              + "' is no member, and none that is in no cell and can be seen",
          "/nodes/" + std::to_string(i),
          "start it, or, where it is in another cell, --take-nodes brings "
          "it here");
    plan.joining.push_back(name);
  }
  if (!options.prune)
    return;
  for (const auto& x : known.cell.nodes) {
    const auto& name = x.identity.name;
    const auto& all = wanted.nodes;
    if (name != known.cell.coordinator
        && std::find(all.begin(), all.end(), name) == all.end())
      plan.leaving.push_back(name);
  }
}

void plan_skills(const cell_options& options, const present_cell& known,
                 const cell_document& wanted, cell_plan& plan) {
  const auto& builds = known.skills.builds;
  for (size_t i = 0; i < wanted.skills.size(); ++i) {
    const auto& x = wanted.skills[i];
    if (std::any_of(builds.begin(), builds.end(),
                    [&](const auto& y) { return y.build.hash == x.build; }))
      continue;
    if (x.source.empty())
      refuse(wanted, error_code::unknown_operation,
             "the cell does not have build "
                 + x.build.substr(0, limits::build::shown_digits) + " of '"
                 + x.operation + "', and there is no source of it",
             "/skills/" + std::to_string(i),
             "say the folder or archive that has it as `source`");
    plan.added.push_back(x);
  }
  if (!options.prune)
    return;
  for (const auto& y : builds)
    if (std::none_of(wanted.skills.begin(), wanted.skills.end(),
                     [&](const auto& x) { return y.build.hash == x.build; }))
      plan.removed.push_back({y.skill.descriptor.operation, y.build.hash, ""});
}

/// Before its nodes and skills are there it cannot be said of a task where it
/// would be.
std::optional<task_plan_shown> plan_of(const cell_options& options,
                                       const node_client& node,
                                       const task_file& file,
                                       const cell_plan& plan) {
  try {
    return plan_apply(options, node, file.request());
  } catch (const refused& why) {
    if (plan.joining.empty() && plan.added.empty())
      throw wrong_document{file, failure_from(why.reply)};
    return std::nullopt;
  }
}

void plan_tasks(const cell_options& options, const node_client& node,
                const present_cell& known, const cell_document& wanted,
                cell_plan& plan) {
  for (const auto& file : wanted.tasks)
    plan.tasks.push_back({file, plan_of(options, node, file, plan)});
  if (!options.prune)
    return;
  const auto end_unwanted = [&](const std::string& task) {
    if (std::none_of(wanted.tasks.begin(), wanted.tasks.end(),
                     [&](const auto& file) {
                       return file.request().value("task", "") == task;
                     }))
      plan.ended.push_back(task);
  };
  for (const auto& x : known.cell.tasks)
    if (x.set.empty())
      end_unwanted(x.task);
  for (const auto& x : known.sets)
    end_unwanted(x.task);
}

bool does_differ(const planned_task& x) {
  return !x.shown || x.shown->differs();
}

std::string build_text(const wanted_skill& x) {
  return x.operation + " " + x.build.substr(0, limits::build::shown_digits);
}

json skills_json(const std::vector<wanted_skill>& skills) {
  auto result = json::array();
  for (const auto& x : skills)
    result.push_back({{"operation", x.operation}, {"build", x.build}});
  return result;
}

} // namespace

present_cell look_at_cell(const node_client& node) {
  return {node.get("/v1/cell").get<cell_description>(),
          node.get("/v1/skills").get<skill_list>(),
          node.get("/v1/tasks").get<task_description>().sets};
}

bool cell_plan::differs() const {
  return !joining.empty() || !added.empty() || !ended.empty()
         || !removed.empty() || !leaving.empty()
         || std::any_of(tasks.begin(), tasks.end(), does_differ);
}

cell_plan plan_cell(const cell_options& options, const node_client& node,
                    const cell_document& wanted) {
  const auto known = look_at_cell(node);
  if (known.cell.cell != wanted.cell)
    refuse(wanted, error_code::unknown_cell,
           "the document is of cell '" + wanted.cell + "', and this is cell '"
               + known.cell.cell + "'",
           "/cell", "ask the other one with --to, or change the name");
  cell_plan plan;
  plan_nodes(options, known, wanted, plan);
  plan_skills(options, known, wanted, plan);
  plan_tasks(options, node, known, wanted, plan);
  return plan;
}

std::string cell_plan_view(const cell_plan& plan, const text_style& style) {
  table t{{{"WHAT"}, {"NAME"}, {"ACTION"}}, {}};
  const auto add = [&](const char* what, const std::string& name,
                       const char* action) {
    t.rows.push_back({std::string{what}, name, std::string{action}});
  };
  for (const auto& x : plan.joining)
    add("node", x, "joins");
  for (const auto& x : plan.added)
    add("skill", build_text(x), "is added");
  std::vector<task_update_plan> changing;
  for (const auto& x : plan.tasks) {
    if (!does_differ(x))
      continue;
    const auto name = x.file.request().value("task", "");
    add("task", name, !x.shown || x.shown->is_new ? "starts" : "changes");
    if (x.shown && !x.shown->set)
      changing.push_back(x.shown->plan);
  }
  for (const auto& x : plan.ended)
    add("task", x, "ends");
  for (const auto& x : plan.removed)
    add("skill", build_text(x), "is removed");
  for (const auto& x : plan.leaving)
    add("node", x, "leaves");
  if (t.rows.empty())
    return "";
  const auto steps = changes_view(changing, style);
  return t.render(style) + (steps.empty() ? "" : "\n" + steps);
}

json cell_plan_json(const cell_plan& plan) {
  json result{{"joining", plan.joining}, {"added", skills_json(plan.added)},
              {"ended", plan.ended},     {"removed", skills_json(plan.removed)},
              {"leaving", plan.leaving}, {"tasks", json::array()}};
  for (const auto& x : plan.tasks) {
    json task{{"task", x.file.request().value("task", "")},
              {"differs", does_differ(x)}};
    if (x.shown)
      task["plan"] = x.shown->set ? message_json(*x.shown->set)
                                  : message_json(x.shown->plan);
    result["tasks"].push_back(std::move(task));
  }
  return result;
}

} // namespace roscell::cli
