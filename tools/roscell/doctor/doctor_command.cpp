#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/doctor/cell/cell_checks.hpp"
#include "tools/roscell/doctor/findings_view.hpp"
#include "tools/roscell/doctor/node/node_checks.hpp"
#include "tools/roscell/doctor/preparation.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

std::vector<check> every_check() {
  auto result = host_checks();
  for (auto& x : node_checks(nullptr))
    result.push_back(std::move(x));
  for (const auto& x : cell_checks())
    result.push_back(x);
  return result;
}

void report_build_step(const std::string& step) {
  if (stderr_is_terminal())
    print_note(step + " ...");
}

void print_running_checks(const std::vector<std::string>& names) {
  if (stderr_is_terminal())
    print_note("still checking: " + joined(names, ", ") + " ...");
}

int run_doctor(const doctor_options& options) {
  if (options.list) {
    print(checks_view(every_check(), stdout_style()));
    return exit_done;
  }
  auto what = prepare(options);
  keep_only(options.only, options.cell, what);
  auto found = run_checks(what.checks, what.host, print_running_checks);
  if (options.cell)
    for (auto& x :
         check_cell(*what.node, what.own, options.only, report_build_step))
      found.push_back(std::move(x));
  found.insert(found.end(), what.known.begin(), what.known.end());
  print(options.output == "json"
            ? pretty(to_json_list(found))
            : findings_view(found, stdout_style(), locale_is_utf8(),
                            command_of(options)));
  return is_broken(found) ? exit_refused : exit_done;
}

constexpr auto doctor_footer =
    "Checks this host, and asks the node that runs here or that --to names. "
    "It changes\nnothing. What is not as it should be is reported with why it "
    "matters and the command that\nfixes it; exit code 1 if something is "
    "broken. Root sees more.\n\n"
    "With --cell every node of the cell checks its host, and tries to reach "
    "every other\none: TCP and UDP of its port, its discovery server, DDS's "
    "data in one piece and in\nfragments, and multicast. For a minute each "
    "opens two UDP ports for that.\n\n"
    "Examples:\n  roscell doctor\n  roscell doctor --interface eth0\n"
    "  roscell doctor --config /etc/roscell/node.conf --only ports,firewall\n"
    "  roscell doctor --cell\n  roscell doctor -o json";

} // namespace

void add_doctor_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<doctor_options>();
  auto* command = app.add_subcommand("doctor", "Diagnose host and cell.");
  command->footer(doctor_footer);
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command
      ->add_option("--config", options->config,
                   "File of options that the node is started with; its "
                   "interface, ports and folders are checked")
      ->option_text("FILE");
  command
      ->add_option("--interface", options->interface,
                   "Network interface or local IPv4 address of the node")
      ->option_text("IF|ADDR [the node's, else the first]");
  command
      ->add_option("--data-dir", options->data_dir,
                   "Where the node keeps its files")
      ->option_text("DIR [the node's]");
  std::vector<std::string> names;
  for (const auto& x : every_check())
    names.emplace_back(x.name);
  command
      ->add_option("--only", options->only,
                   "Only these checks; --list names them")
      ->delimiter(',')
      // Scripts may still say it; what it told of is part of `leftovers`.
      ->transform(CLI::Transformer({{"shm-sharing", "leftovers"}}))
      ->check(CLI::IsMember(names))
      ->option_text("CHECK...");
  command->add_flag("--cell", options->cell,
                    "Also check all nodes of the cell, and each pair");
  command->add_flag("--list", options->list, "List the checks, and end");
  command->callback([&chosen, options] {
    chosen = [options] { return run_doctor(*options); };
  });
}

} // namespace roscell::cli
