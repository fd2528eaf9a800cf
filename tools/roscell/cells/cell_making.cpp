#include "messages/formation.hpp"
#include "tools/roscell/cells/cell_plan.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/cell_skills.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <chrono>

/// A cell becomes what a document says: first what its tasks need, last what is
/// not wanted any more.
namespace roscell::cli {

namespace {

/// Longer than the coordinator's own limits, so that its answer is heard.
constexpr std::chrono::minutes formation_limit{16};
constexpr std::chrono::minutes removal_limit{2};

json ask(const node_client& node, const json& message,
         std::chrono::milliseconds limit) {
  return unless_refused(node.post("/v1/requests", message.dump(), limit),
                        false);
}

void bring_nodes(const node_client& node,
                 const std::vector<std::string>& names) {
  if (names.empty())
    return;
  print_note("brings in " + printable(joined(names, ", ")));
  const auto formed =
      ask(node,
          message_json(cell_formation{names, instance_policy::reschedule}),
          formation_limit)
          .get<cell_formed>();
  for (const auto& x : formed.outcomes)
    if (x.result == formation_result::failed)
      throw command_error{exit_refused,
                          "node '" + printable(x.node)
                              + "' has not come: " + printable(x.message),
                          printable(x.hint)};
}

void make_tasks(const cell_options& options, const node_client& node,
                const std::vector<planned_task>& tasks) {
  for (const auto& x : tasks) {
    try {
      const auto shown =
          x.shown ? *x.shown : plan_apply(options, node, x.file.request());
      if (!shown.differs())
        continue;
      make_apply(options, node, shown);
      print_note("task '" + printable(shown.plan.task) + "' runs");
    } catch (const refused& why) {
      throw wrong_document{x.file, failure_from(why.reply)};
    }
  }
}

void remove_rest(const cell_options& options, const node_client& node,
                 const cell_plan& plan) {
  for (const auto& x : plan.ended) {
    ask_or_throw(options, x, message_json(task_termination{x, options.force}));
    print_note("task '" + printable(x) + "' is ended");
  }
  for (const auto& x : plan.removed) {
    ask(node, message_json(skill_removal{x.operation, x.build}), removal_limit);
    print_note("skill '" + printable(x.operation) + "' is removed");
  }
  for (const auto& x : plan.leaving) {
    node_release request;
    request.node = x;
    request.instances = instance_policy::reschedule;
    ask(node, message_json(request), formation_limit);
    print_note("node '" + printable(x) + "' is released");
  }
}

} // namespace

void make_cell(const cell_options& options, const node_client& node,
               const cell_plan& plan) {
  bring_nodes(node, plan.joining);
  for (const auto& x : plan.added) {
    add_to_cell(node, x.source, x.build, false);
    print_note("skill '" + printable(x.operation) + "' is added");
  }
  make_tasks(options, node, plan.tasks);
  remove_rest(options, node, plan);
}

} // namespace roscell::cli
