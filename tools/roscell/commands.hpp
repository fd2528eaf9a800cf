#pragma once

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

/// Each function adds one command, or a family of them, to the command line.
/// When such a command is parsed, it puts what is to be done into `chosen`;
/// that returns the exit code, or throws command_error or refused.
namespace roscell::cli {

using action = std::function<int()>;

void add_node_command(CLI::App& app, action& chosen);
void add_request_command(CLI::App& app, action& chosen);
void add_plan_command(CLI::App& app, action& chosen);

/// form, transfer, release.
void add_form_commands(CLI::App& app, action& chosen);
void add_drain_commands(CLI::App& app, action& chosen);
void add_rebalance_command(CLI::App& app, action& chosen);

/// apply, diff and export, below `cell`.
void add_cell_command(CLI::App& app, action& chosen);

/// status, cells, nodes, transfers, tasks, instances, topics, skills.
void add_show_commands(CLI::App& app, action& chosen);

/// run, apply, rollback, stop, restart, set.
void add_task_commands(CLI::App& app, action& chosen);
void add_apply_command(CLI::App& app, action& chosen);
void add_rollback_command(CLI::App& app, action& chosen);
void add_stop_command(CLI::App& app, action& chosen);
void add_set_command(CLI::App& app, action& chosen);

void add_check_command(CLI::App& app, action& chosen);

/// new task, new config.
void add_new_command(CLI::App& app, action& chosen);

/// `config`, below `new`.
void add_new_config_command(CLI::App& app, CLI::App& parent, action& chosen);

/// `show`, `new` and `check`, below `skills`.
void add_skill_show_command(CLI::App& skills, action& chosen);
void add_skill_new_command(CLI::App& skills, action& chosen);
void add_skill_check_command(CLI::App& skills, action& chosen);
void add_skill_add_command(CLI::App& skills, action& chosen);
void add_skill_sign_command(CLI::App& skills, action& chosen);
void add_skill_pull_command(CLI::App& skills, action& chosen);
void add_skill_remove_command(CLI::App& skills, action& chosen);

/// env.
void add_env_command(CLI::App& app, action& chosen);

void add_echo_command(CLI::App& app, action& chosen);

/// hz, bw.
void add_traffic_commands(CLI::App& app, action& chosen);

/// why, trace.
void add_decision_commands(CLI::App& app, action& chosen);

void add_inspect_command(CLI::App& app, action& chosen);

void add_doctor_command(CLI::App& app, action& chosen);
void add_dashboard_command(CLI::App& app, action& chosen);
void add_top_command(CLI::App& app, action& chosen);
void add_graph_command(CLI::App& app, action& chosen);
void add_describe_command(CLI::App& app, action& chosen);
void add_events_command(CLI::App& app, action& chosen);
void add_logs_command(CLI::App& app, action& chosen);
void add_exec_command(CLI::App& app, action& chosen);

/// What makes and looks after a site of identities, below `site`.
void add_site_command(CLI::App& app, action& chosen);
void add_login_command(CLI::App& app, action& chosen);
void add_audit_command(CLI::App& app, action& chosen);

/// set, list and remove, below `secret`.
void add_secret_command(CLI::App& app, action& chosen);

void add_shell_command(CLI::App& app, action& chosen);
void add_completion_command(CLI::App& app, action& chosen);

/// help, version.
void add_help_commands(CLI::App& app, action& chosen);

/// All of them, with help that names the exit codes.
void set_up(CLI::App& app, action& chosen);

/// The whole program: parses the command line and does what it says. Returns
/// the exit code (tools/roscell/exit_code.hpp).
int run(int argc, char** argv);

/// Adds commands to the command line.
using command_set = std::function<void(CLI::App& app, action& chosen)>;

/// The same for words that stand behind the program's name, with these
/// commands in place of its own.
int run(const command_set& commands, std::vector<std::string> words);

} // namespace roscell::cli
