#include "messages/failure.hpp"
#include "messages/instance.hpp"
#include "schemas/utf8.hpp"
#include "tools/roscell/client/find_instance.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exec/local_streams.hpp"
#include "tools/roscell/exec/raw_terminal.hpp"
#include "tools/roscell/exec/remote_command.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

struct exec_options {
  connection_options connection;
  std::string subject; ///< An instance, or the beginning of its id.
  std::vector<std::string> command;
  bool no_terminal = false;
  bool no_input = false;
};

exec_request request_for(const exec_options& options,
                         const instance_row& instance, bool terminal) {
  exec_request result;
  result.instance = instance.spec.instance;
  result.node = instance.node;
  result.command = options.command;
  result.terminal = terminal;
  if (terminal) {
    const auto size = size_of_terminal();
    result.columns = size.columns;
    result.rows = size.rows;
  }
  return result;
}

/// The exit code of a command whose output nobody reads any more.
constexpr int unread = 128 + SIGPIPE;

/// Passes its output on until it has ended. Returns its exit code.
int follow(remote_command& command, std::string& reason) {
  for (;;) {
    const auto output = command.more();
    if (!write_all(output.of_errors ? STDERR_FILENO : STDOUT_FILENO,
                   output.bytes, command)) {
      command.hang_up();
      return unread;
    }
    reason = output.reason;
    if (output.ended)
      return output.exit_code;
  }
}

constexpr const char* lost_hint =
    "what it runs is ended by its node, within 15 s at most";

/// What ends our connection leaves the command to its node.
[[noreturn]] void throw_lost(const std::string& why, exit_code code) {
  throw command_error{code, "the command is out of reach: " + why, lost_hint};
}

int attach(const node_client& node, const exec_request& what,
           const attachment_options& how) {
  const taken_signals signals;
  remote_command command{node, what};
  std::optional<raw_terminal> raw;
  if (how.terminal)
    raw.emplace();
  std::string reason;
  int code = exit_refused;
  try {
    const local_streams streams{command, how, signals, [&raw] { raw.reset(); }};
    code = follow(command, reason);
  } catch (const refused& e) {
    raw.reset();
    throw_lost(failure_from(e.reply).message, exit_code_of_refusal(e.reply));
  } catch (const command_error& e) {
    raw.reset();
    throw_lost(e.what(), e.code);
  }
  raw.reset();
  if (!reason.empty())
    print_error("the command was ended: " + reason);
  return !reason.empty() && code == 0 ? exit_refused : code;
}

int execute(const exec_options& options) {
  for (const auto& x : options.command)
    if (valid_utf8(x) != x)
      throw command_error{exit_usage,
                          "the command is no UTF-8: '" + printable(x) + "'",
                          "give such bytes on its standard input"};
  const node_client node{options.connection};
  const auto instance = find_instance(node, options.subject);
  attachment_options how;
  how.no_input = options.no_input;
  how.terminal = !options.no_terminal && !options.no_input
                 && ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0;
  return attach(node, request_for(options, instance, how.terminal), how);
}

} // namespace

void add_exec_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<exec_options>();
  auto* command = app.add_subcommand(
      "exec", "Run a command beside a skill instance, in its environment.");
  command->footer(
      "It runs on the node of the instance, in its container or with the "
      "variables, folder, user\nand limits of its process, and the instance "
      "goes on undisturbed. With a terminal at both\nends it gets one, and "
      "Ctrl-C goes there; else standard input is passed on to its end, and\n"
      "standard error stays apart. It ends with this command, and with the "
      "instance. The exit code\nis its own: 128 + n after signal n, 127 where "
      "it cannot be found.\n\n"
      "Examples:\n  roscell exec fleet-poses-camera-1a2b3c4d -- bash\n"
      "  roscell exec fleet-poses/camera -- ls -l /dev/shm | wc -l\n"
      "  roscell exec camera -- sh -c 'cat > /tmp/scene.json' < scene.json");
  add_connection_options(*command, options->connection);
  command
      ->add_option("INSTANCE", options->subject,
                   "Id of the instance or its beginning, or TASK/STEP")
      ->required();
  command
      ->add_option("PROGRAM", options->command,
                   "What to run, with its arguments, after --")
      ->required()
      ->option_text("...");
  command->add_flag("-T,--no-terminal", options->no_terminal,
                    "Give it no terminal, even from one");
  command->add_flag("-n,--no-input", options->no_input,
                    "Pass no standard input on, as in loops of scripts");
  command->add_flag("-i,--interactive",
                    "Pass standard input on, as is done anyway");
  command->callback(
      [&chosen, options] { chosen = [options] { return execute(*options); }; });
}

} // namespace roscell::cli
