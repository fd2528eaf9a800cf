#include "actors/node/config_checks.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/config/config_file.hpp"
#include "tools/roscell/config/node_source.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>

namespace roscell::cli {

namespace {

constexpr auto footer =
    R"(Ctrl-C or SIGTERM leaves the cell in order; a second one ends at once.
Running instances go on, and the node takes them over when it is started again.

Examples:
  roscell node --coordinator --interface eth0
  roscell node --interface eth0 --join 192.168.1.10 --label room=lab
  roscell node --coordinator --interface lo --data-dir ~/n1 --runtime process
  roscell node --config /etc/roscell/node.conf)";

/// A name that is not empty: a script whose variable is not set says nothing,
/// and means something. CLI11 does not check empty values.
CLI::Option* add_name(CLI::App& command, const std::string& option,
                      std::string& name, const std::string& description) {
  return command.add_option_function<std::string>(
      option,
      [option, &name](const std::string& said) {
        if (said.empty())
          throw CLI::ValidationError{
              option, "the name is empty: leave the option out, or say one"};
        name = said;
      },
      description);
}

void add_identity(CLI::App& command, node_options& options) {
  auto& config = options.config;
  add_name(command, "--name", config.name, "Unique name of this node")
      ->option_text("NAME [node-MAC]");
  command.add_flag("--coordinator", config.coordinator,
                   "Also manage a cell, as its coordination node");
  add_name(command, "--cell", config.cell, "Name of the coordinator's cell")
      ->option_text("NAME [the node's name]");
  command
      .add_option("--label", options.labels,
                  "A label that steps may ask for; can be repeated")
      ->option_text("KEY=VALUE")
      ->allow_extra_args(false);
}

void add_network(CLI::App& command, node_options& options) {
  auto& config = options.config;
  command
      .add_option("--interface", options.interface,
                  "Network interface or local IPv4 address to use; a terminal "
                  "is asked if it is left out")
      ->option_text("IF|ADDR");
  command
      .add_option("--join", config.join,
                  "Discovery server of the cell to join (port 11811); without "
                  "it the node asks the coordinators that it sees for a place")
      ->option_text("HOST[:PORT]");
  command.add_flag("--wait", config.wait,
                   "Ask for no place: wait until a coordinator chooses the "
                   "node");
  command
      .add_option("--peer", config.peers,
                  "Another node of the site, where multicast does not reach "
                  "it; can be repeated")
      ->option_text("HOST[:PORT]")
      ->allow_extra_args(false);
  command
      .add_option("--public-domain", config.public_domain_id,
                  "DDS domain in which the nodes of the site see each other, "
                  "0 to 232")
      ->check(CLI::Range(0, 232))
      ->option_text("ID [99]");
  command.add_flag_callback(
      "--no-rebalance", [&config] { config.rebalance = false; },
      "Keep this cell out when cells are balanced");
  command.add_flag("--ros2-set-parameters", config.ros2_set_parameters,
                   "Let clients of ROS 2, who prove nothing, change parameters "
                   "of running skills");
  command.add_flag("--force", config.force,
                   "Take the cell's name although another coordinator has it");
  command
      .add_option("--port", config.http_port,
                  "HTTP and sessions (TCP), heartbeats (UDP); 0: any free one")
      ->option_text("PORT [8420]");
  command
      .add_option("--discovery-port", config.discovery_port,
                  "UDP port of the discovery server; 0: any free one")
      ->option_text("PORT [11811]");
  command
      .add_option("--server-id", config.server_id,
                  "Id of the discovery server, 0 to 255")
      ->option_text("ID [lowest free]");
  command
      .add_option("--domain-id", config.ros_domain_id,
                  "ROS domain of the cell's skills, 0 to 232")
      ->check(CLI::Range(0, 232))
      ->option_text("ID [0]");
  command
      .add_option(
          "--site-token", config.site_token_file,
          "Secret that the nodes of a site share: a copy of another host's, "
          "or of another user's. The first coordinator of a user makes his")
      ->option_text("FILE [$ROSCELL_SITE_TOKEN, else /etc/roscell/site.token "
                    "for root, ~/.config/roscell/site.token]");
}

void add_site(CLI::App& command, node_options& options) {
  command
      .add_option("--identity", options.config.identity_file,
                  "What the node is at a site of identities, in place of a "
                  "token: `roscell site issue` makes it")
      ->option_text("FILE [DATA_DIR/identity.pem, if it is there]");
  command
      .add_option("--invite", options.config.invitation,
                  "By what a node gets an identity that has none: the line "
                  "that `roscell site invite` prints, or a file with it")
      ->option_text("LINE|FILE");
  command.add_flag("--require-signed-skills",
                   options.config.require_signed_skills,
                   "Place nothing but builds of skills that an operator of the "
                   "site has signed");
}

std::string names_a_cgroup(const std::string& text) {
  return text == "auto" || text == "none" || text.rfind('/', 0) == 0
             ? std::string{}
             : "give a folder that begins with '/', auto or none";
}

std::string names_a_runtime(const std::string& text) {
  const auto colon = text.find(':');
  const auto name = text.substr(0, colon);
  const bool is_engine = name == "docker" || name == "podman";
  if (colon == std::string::npos)
    return is_engine || name == "auto" || name == "process"
               ? ""
               : "not auto, process, docker or podman";
  return is_engine && text.compare(colon, 2, ":/") == 0
             ? ""
             : "not docker:/PATH or podman:/PATH";
}

void add_resources(CLI::App& command, node_options& options) {
  auto& config = options.config;
  command.add_option("--runtime", config.runtime, "What runs skill instances")
      ->check(names_a_runtime)
      ->option_text("auto|process|docker[:SOCKET]|podman[:SOCKET] [auto]");
  command
      .add_option(
          "--skills", options.skill_dirs,
          "Directory of skill folders, besides those that are installed "
          "and DATA_DIR/skills; can be repeated")
      ->option_text("DIR")
      ->allow_extra_args(false);
  command
      .add_option("--grant", config.grants,
                  "What a skill may have beyond an ordinary program's due: "
                  "capability:NET_RAW, user:NAME, scheduling:fifo:PRIORITY, "
                  "scheduling:rr:PRIORITY, scheduling:nice:VALUE. SKILL is its "
                  "operation, or * for all; can be repeated")
      ->check(grant_problem)
      ->option_text("SKILL=WHAT[,WHAT...]")
      ->allow_extra_args(false);
  command
      .add_option("--cgroup", config.cgroup,
                  "Where instances that are processes get cgroups, which hold "
                  "them to their memory: a folder of the cgroup file system, "
                  "auto or none")
      ->check(names_a_cgroup)
      ->envname("ROSCELL_CGROUP")
      ->option_text("FOLDER|auto|none [$ROSCELL_CGROUP, else auto]");
  command
      .add_option("--capacity", config.capacity,
                  "Offer no more than this: cores, MiB, MiB")
      ->option_text("cpu=N,memory_mib=N,disk_mib=N [all]");
  command
      .add_option("--cpu-floor", config.cpu_floor,
                  "Part of the cores on which a task may count while other "
                  "programs keep all of them busy; 0: none")
      ->check(CLI::Range(0.0, 1.0))
      ->option_text("FRACTION [0.25]");
  command
      .add_option("--device", config.devices,
                  "Offer this device as well; can be repeated")
      ->option_text("PATH")
      ->allow_extra_args(false);
}

/// What comes from other nodes and registries.
void add_builds(CLI::App& command, node_options& options) {
  command
      .add_option("--builds-bytes", options.builds_bytes,
                  "Bound of the builds of skills that come from other nodes. "
                  "What was not used for longest goes first")
      ->option_text("BYTES [20GiB]");
  command
      .add_option("--registry-auth", options.config.registry_auth,
                  "How to log in to registries of container images, in the "
                  "form of Docker's config.json; others may not read it. "
                  "Otherwise as the user of the engine does")
      ->option_text("FILE");
  command
      .add_option("--skill-images", options.config.skill_images,
                  "Images of skills that are kept though no container has "
                  "them. The oldest go first")
      ->check(CLI::Range(0, 10'000))
      ->option_text("NUMBER [20]");
}

void add_files(CLI::App& command, node_options& options) {
  auto& config = options.config;
  command
      .add_option("--data-dir", config.data_dir,
                  "Where the node keeps its identity, token, state and logs")
      ->option_text("DIR [/var/lib/roscell for root, "
                    "else ~/.local/state/roscell]");
  command
      .add_option("--socket", config.socket, "Unix socket for local requests")
      ->option_text("PATH [DATA_DIR/node.sock]");
  command.add_flag("--new-identity", config.new_identity,
                   "Once: begin anew in a data directory that was used. What "
                   "the node knew is put aside, and what it ran is ended");
  command
      .add_option("--log-bytes", options.log_bytes,
                  "Bound of the log that is kept of one instance")
      ->option_text("BYTES [1MiB]");
  command
      .add_option("--history-bytes", options.history_bytes,
                  "Bound of what is kept of the past: events, and logs of "
                  "instances that are gone. The oldest goes first")
      ->option_text("BYTES [64MiB]");
  add_builds(command, options);
  command
      .add_option("--history-age", options.history_age,
                  "The same in time: 12h, 30d")
      ->option_text("TIME [7d]");
  command
      .add_option(
          "--drain-timeout", options.drain_timeout,
          "When it is to stop, move its instances to other nodes first, "
          "for so long at most")
      ->option_text("TIME [0]");
  command
      .add_option("--log-level", options.log_level,
                  "What the node itself logs on standard error")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->option_text("trace|debug|info|warn|error|off [info]");
  command
      .add_option(
          "--ready-fd", options.ready_fd,
          "Write a line to this file descriptor once the node is ready; "
          "$NOTIFY_SOCKET of systemd is notified as well")
      ->check(CLI::Range(0, 1 << 20))
      ->option_text("NUMBER");
}

/// The whole command line would stay in memory for as long as the node runs.
void forget_commands(CLI::App& app) {
  for (auto* x : app.get_subcommands({}))
    app.remove_subcommand(x);
}

} // namespace

void add_node_options(CLI::App& command, node_options& options) {
  add_identity(command, options);
  add_network(command, options);
  add_site(command, options);
  add_resources(command, options);
  add_files(command, options);
}

void add_node_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<node_options>();
  auto file = std::make_shared<std::filesystem::path>();
  auto* command = app.add_subcommand(
      "node", "Run a node on this machine, until Ctrl-C or SIGTERM.");
  command->footer(footer);
  add_node_options(*command, *options);
  command
      ->add_option("--config", *file,
                   "File of lines `OPTION = VALUE`; what the command line says "
                   "comes first. `roscell new config` prints one to begin with")
      ->option_text("FILE");
  command->callback([&chosen, command, options, file] {
    chosen = [command, file] {
      const node_source source{*command, *file};
      forget_commands(*command->get_parent());
      return run_node(source);
    };
  });
}

} // namespace roscell::cli
