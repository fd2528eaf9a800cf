#include "tools/roscell/tasks/preemption.hpp"

#include "messages/task.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

void add_preemption_options(CLI::App& command, preemption_options& options) {
  auto* preempt = command.add_flag(
      "--preempt", options.preempt,
      "Where the task does not fit, show which instances of lower priority "
      "would have to go");
  command
      .add_flag(
          "--yes", options.yes,
          "End these, once they are stop-safe, and start them elsewhere where "
          "there is room")
      ->needs(preempt);
  command.add_flag(
      "--force", options.force,
      "Do not wait for those that are not stop-safe; and hosts that "
      "would start steps of the task alone stay off");
}

void apply(const preemption_options& options, json& request) {
  if (!request.is_object()
      || request.value("type", json{}) != task_request::type)
    return;
  if (options.preempt)
    request["preempt"] = options.yes ? "yes" : "show";
  if (options.force)
    request["force"] = true;
}

} // namespace roscell::cli
