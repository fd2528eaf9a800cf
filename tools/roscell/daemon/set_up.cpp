#include "tools/roscell/commands.hpp"

#include "actors/core/program_version.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

namespace {

constexpr auto exit_codes_and_examples = R"(Exit codes:
  0  done
  1  refused; standard error says why, or the JSON error on standard output
  2  wrong usage
  3  no node could be reached

Environment:
  ROSCELL_TO          node to talk to: unix:/path, /path, or host[:port]
  ROSCELL_TOKEN       bearer token for TCP
  ROSCELL_TIMEOUT     longest wait for an answer: 2 (seconds), 600ms
  ROSCELL_SITE_TOKEN  where this user's site token is, for nodes
  NO_COLOR            set to anything for output without colours

Examples:
  roscell node --coordinator --interface eth0
  roscell node --interface eth0 --join 192.168.1.10
  roscell form arm-1 arm-2
  roscell run task.yaml
  roscell tasks --watch
`roscell COMMAND --help` explains a command and shows how it is used.)";

} // namespace

void set_up(CLI::App& app, action& chosen) {
  app.name("roscell");
  app.description("Cells of robots, edge boxes and cloud hosts.");
  app.footer(exit_codes_and_examples);
  app.set_version_flag("--version", std::string{"roscell "} + program_version,
                       "Print the version and exit");
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  add_node_command(app, chosen);
  add_task_commands(app, chosen);
  add_check_command(app, chosen);
  add_new_command(app, chosen);
  add_request_command(app, chosen);
  add_plan_command(app, chosen);
  add_form_commands(app, chosen);
  add_drain_commands(app, chosen);
  add_rebalance_command(app, chosen);
  add_cell_command(app, chosen);
  add_show_commands(app, chosen);
  add_describe_command(app, chosen);
  add_graph_command(app, chosen);
  add_decision_commands(app, chosen);
  add_inspect_command(app, chosen);
  add_top_command(app, chosen);
  add_doctor_command(app, chosen);
  add_dashboard_command(app, chosen);
  add_env_command(app, chosen);
  add_echo_command(app, chosen);
  add_traffic_commands(app, chosen);
  add_events_command(app, chosen);
  add_logs_command(app, chosen);
  add_exec_command(app, chosen);
  add_secret_command(app, chosen);
  add_site_command(app, chosen);
  add_login_command(app, chosen);
  add_audit_command(app, chosen);
  add_shell_command(app, chosen);
  add_completion_command(app, chosen);
  add_help_commands(app, chosen);
}

} // namespace roscell::cli
