#include "messages/failure.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/daemon/config_file.hpp"
#include "tools/roscell/daemon/node_options.hpp"
#include "tools/roscell/doctor/cell/cell_examination.hpp"
#include "tools/roscell/doctor/checks.hpp"
#include "tools/roscell/doctor/findings_view.hpp"
#include "tools/roscell/doctor/node/node_checks.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

struct doctor_options {
  connection_options connection;
  std::string output = "table";
  fs::path config;
  std::string interface;
  fs::path data_dir;
  std::vector<std::string> only;
  bool list = false;
  bool cell = false;
};

/// What is looked at, and by what.
struct examination {
  examined_host host;
  std::vector<check> checks;
  findings known; ///< Found while it was prepared.
  std::shared_ptr<const node_client> node;
  std::string own; ///< Name of the node that runs here; empty: none does.
};

/// The host of a node that is started with these options.
examined_host host_of(const doctor_options& options) {
  node_options node;
  CLI::App command{"", "node"};
  add_node_options(command, node);
  if (!options.config.empty())
    take_config(command, options.config);
  examined_host result;
  result.config = node.config;
  result.config.skill_dirs = node.skill_dirs;
  result.interface =
      options.interface.empty() ? node.interface : options.interface;
  if (!options.data_dir.empty())
    result.config.data_dir = fs::absolute(options.data_dir);
  return result;
}

/// Looks at the host with the node in mind that runs there.
void follow_node(examined_host& host, const node_client& node,
                 const node_description& told) {
  const auto& address = told.identity.address;
  const auto colon = address.rfind(':');
  if (host.interface.empty())
    host.interface = address.substr(0, colon);
  if (colon != address.npos)
    host.config.http_port =
        static_cast<uint16_t>(std::atoi(address.c_str() + colon + 1));
  if (host.config.data_dir.empty() && node.where().is_local())
    host.config.data_dir = node.where().socket.parent_path();
  host.node_runs = true;
}

/// A finding that no check has made.
finding named_finding(const std::string& check, const char* area, finding x) {
  x.check = check;
  x.area = area;
  return x;
}

/// A node that does not answer is worth a word where it was named, or where
/// something lies that looks like one.
void tell_of_no_node(const doctor_options& options, const target& where,
                     const command_error& why, findings& known) {
  const bool named = !options.connection.to.empty();
  std::error_code error;
  if (!named && where.is_local() && !fs::exists(where.socket, error)
      && error != std::errc::permission_denied)
    return;
  known.push_back(named_finding("node", "node",
                                {named ? judgement::broken : judgement::skipped,
                                 why.what(), why.hint, "roscell status"}));
}

bool is_here(const target& where) {
  if (where.is_local() || where.host == "localhost")
    return true;
  const auto all = list_interfaces();
  return std::any_of(all.begin(), all.end(),
                     [&](auto& x) { return x.address == where.host; });
}

/// Where the node answers that these options are of, unless another was named.
connection_options connection_to(const doctor_options& options,
                                 const node_config& config) {
  auto result = options.connection;
  const auto socket = !config.socket.empty() || config.data_dir.empty()
                          ? config.socket
                          : config.data_dir / "node.sock";
  std::error_code error;
  if (result.to.empty() && std::getenv("ROSCELL_TO") == nullptr
      && fs::exists(socket, error))
    result.to = fs::absolute(socket).string();
  return result;
}

examination prepare(const doctor_options& options) {
  examination result;
  result.host = host_of(options);
  auto node = std::make_shared<const node_client>(
      connection_to(options, result.host.config));
  result.node = node;
  const bool here = is_here(node->where());
  if (here)
    result.checks = host_checks();
  else
    result.known.push_back(
        named_finding("host", "host",
                      {judgement::skipped, "the node runs on another host", "",
                       "ssh " + node->where().host + " roscell doctor"}));
  try {
    const auto told = node->get("/v1/node").get<node_description>();
    if (here) {
      follow_node(result.host, *node, told);
      result.own = told.identity.name;
    }
    for (auto& x : node_checks(node))
      result.checks.push_back(std::move(x));
  } catch (const command_error& e) {
    tell_of_no_node(options, node->where(), e, result.known);
  } catch (const refused& e) {
    const auto why = failure_from(e.reply);
    result.known.push_back(named_finding(
        "node", "node", {judgement::broken, why.message, why.hint}));
  }
  if (result.host.config.data_dir.empty())
    result.host.config.data_dir = default_data_dir();
  return result;
}

/// Why a check that was asked for by name is not made.
std::string unmade(const std::string& name) {
  return is_cell_check(name)
             ? "it looks at a whole cell: add --cell"
             : "there is no node that can be asked, or it runs on another host";
}

/// Leaves out what was not asked for. A node that was named and does not answer
/// stays.
void keep_only(const std::vector<std::string>& names, bool cell,
               examination& what) {
  if (names.empty())
    return;
  auto& checks = what.checks;
  const auto has = [](const auto& list, const auto& is) {
    return std::any_of(list.begin(), list.end(), is);
  };
  checks.erase(std::remove_if(checks.begin(), checks.end(),
                              [&](auto& x) {
                                return !has(names, [&](auto& name) {
                                  return name == x.name;
                                });
                              }),
               checks.end());
  if (!is_broken(what.known))
    what.known.clear();
  for (const auto& name : names)
    if (!(cell && is_cell_check(name))
        && !has(checks, [&](auto& x) { return x.name == name; }))
      what.known.push_back(
          named_finding(name, "node", {judgement::skipped, unmade(name)}));
}

std::vector<check> every_check() {
  auto result = host_checks();
  for (auto& x : node_checks(nullptr))
    result.push_back(std::move(x));
  for (const auto& x : cell_checks())
    result.push_back(x);
  return result;
}

void tell_step(const std::string& step) {
  if (stderr_is_terminal())
    print_note(step + " ...");
}

void tell_who_looks(const std::vector<std::string>& names) {
  if (stderr_is_terminal())
    print_note("still looking: " + joined(names, ", ") + " ...");
}

int examine(const doctor_options& options) {
  if (options.list) {
    print(checks_view(every_check(), stdout_style()));
    return exit_done;
  }
  auto what = prepare(options);
  keep_only(options.only, options.cell, what);
  auto found = run_checks(what.checks, what.host, tell_who_looks);
  if (options.cell)
    for (auto& x : examine_cell(*what.node, what.own, options.only, tell_step))
      found.push_back(std::move(x));
  found.insert(found.end(), what.known.begin(), what.known.end());
  print(options.output == "json"
            ? pretty(to_json_list(found))
            : findings_view(found, stdout_style(), locale_is_utf8()));
  return is_broken(found) ? exit_refused : exit_done;
}

constexpr auto doctor_footer =
    "Looks at this host, and asks the node that runs here or that --to names. "
    "It changes\nnothing. What is not as it should be is told with why it "
    "matters and the command that\nmends it; exit code 1 if something is "
    "broken. Root sees more.\n\n"
    "With --cell every node of the cell looks at its host, and tries to reach "
    "every other\none: TCP and UDP of its port, its discovery server, DDS's "
    "data in one piece and in\nfragments, and multicast. For a minute each "
    "opens one UDP port for that.\n\n"
    "Examples:\n  roscell doctor\n  roscell doctor --interface eth0\n"
    "  roscell doctor --config /etc/roscell/node.conf --only ports,firewall\n"
    "  roscell doctor --cell\n  roscell doctor -o json";

} // namespace

void add_doctor_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<doctor_options>();
  auto* command = app.add_subcommand(
      "doctor", "Say what of this host keeps a node or a cell from working.");
  command->footer(doctor_footer);
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command
      ->add_option("--config", options->config,
                   "File of options that the node is started with; its "
                   "interface, ports and folders are looked at")
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
      ->check(CLI::IsMember(names))
      ->option_text("CHECK...");
  command->add_flag("--cell", options->cell,
                    "Also look at all nodes of the cell, and at each pair");
  command->add_flag("--list", options->list, "List the checks, and end");
  command->callback(
      [&chosen, options] { chosen = [options] { return examine(*options); }; });
}

} // namespace roscell::cli
