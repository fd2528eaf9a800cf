#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/environment.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

struct env_options {
  connection_options connection;
  std::string output = "shell";
  bool super_client = false;
};

/// Of the cell that was asked for last; programs that run keep what they read.
/// Nobody else may have put the folder there.
fs::path write_profile(const variables& environment) {
  const auto text = super_client_profile(environment);
  const auto* runtime = std::getenv("XDG_RUNTIME_DIR");
  const auto folder = runtime != nullptr && *runtime != '\0'
                          ? fs::path{runtime} / "roscell"
                          : fs::temp_directory_path()
                                / ("roscell-" + std::to_string(::geteuid()));
  std::error_code error;
  fs::create_directories(folder, error);
  fs::permissions(folder, fs::perms::owner_all, error);
  struct stat found {};
  if (::lstat(folder.c_str(), &found) != 0 || !S_ISDIR(found.st_mode)
      || found.st_uid != ::geteuid())
    throw command_error{exit_refused,
                        folder.string() + " is no folder of yours",
                        "set XDG_RUNTIME_DIR to one"};
  auto file = folder / "super_client.xml";
  std::ofstream out{file, std::ios::trunc};
  out << text << std::flush;
  if (!out)
    throw command_error{exit_refused, "cannot write " + file.string(),
                        "set XDG_RUNTIME_DIR to a folder of yours"};
  return file;
}

int print_environment(const env_options& options) {
  const node_client node{options.connection};
  const auto said = node.get("/v1/node").get<node_description>();
  if (said.environment.empty())
    throw command_error{
        exit_refused,
        "node '" + said.identity.name
            + "' has no discovery server to name: it is in no cell, or not yet",
        "`roscell status` shows where it stands; --to asks another node"};
  if (options.output == "json")
    print(pretty(json(said.environment)));
  else if (options.super_client)
    print(super_client_lines(said.cell, said.environment,
                             write_profile(said.environment)));
  else
    print(shell_lines(said.cell, said.environment));
  return exit_done;
}

} // namespace

void add_env_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<env_options>();
  auto* command = app.add_subcommand(
      "env", "Print what a shell needs for ROS 2 programs in the cell.");
  command->footer(
      "Programs find each other by the discovery server of the node that is "
      "asked, which is\nthis host's unless --to names another.\n\nExamples:\n"
      "  eval \"$(roscell env)\"; ros2 run demo_nodes_cpp listener\n"
      "  eval \"$(roscell env --super-client)\"; ros2 daemon stop; ros2 topic "
      "list");
  add_connection_options(*command, options->connection);
  command
      ->add_option("-o,--output", options->output,
                   "shell: lines to evaluate; json: the variables")
      ->check(CLI::IsMember({"shell", "json"}))
      ->capture_default_str()
      ->option_text("FORMAT");
  command->add_flag("--super-client", options->super_client,
                    "For the ros2 command: see all topics of the cell");
  command->callback([&chosen, options] {
    chosen = [options] { return print_environment(*options); };
  });
}

} // namespace roscell::cli
