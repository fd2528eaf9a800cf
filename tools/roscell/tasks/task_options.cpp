#include "tools/roscell/tasks/task_options.hpp"

#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

CLI::App* add_task_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           task_options& options) {
  auto* command = app.add_subcommand(name, description);
  command->footer(footer);
  add_connection_options(*command, options.connection);
  add_timeout_option(*command, options.timeout);
  add_output_option(*command, options.output);
  return command;
}

void add_force_option(CLI::App& command, task_options& options) {
  command.add_flag("--force", options.force,
                   "Do not wait for what is not stop-safe");
}

json ask_about(const task_options& options, const std::string& task,
               const json& request) {
  const node_client node{options.connection};
  const auto lines = [task](const event& e) { return progress_lines(e, task); };
  return post_with_progress(node, request.dump(),
                            parse_duration(options.timeout), lines);
}

json ask_or_throw(const task_options& options, const std::string& task,
                  const json& request) {
  return unless_refused(ask_about(options, task, request), options.as_json());
}

} // namespace roscell::cli
