#include "tools/roscell/doctor/preparation.hpp"

#include "actors/edge/host/interfaces.hpp"
#include "messages/node.hpp"
#include "tools/roscell/config/config_file.hpp"
#include "tools/roscell/config/node_options.hpp"
#include "tools/roscell/doctor/cell/cell_checks.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"
#include "tools/roscell/doctor/node/node_checks.hpp"
#include "tools/roscell/doctor/node/own_node.hpp"
#include "tools/roscell/exit_code.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

/// The host of a node that is started with these options.
checked_host host_of(const doctor_options& options) {
  node_options node;
  CLI::App command{"", "node"};
  add_node_options(command, node);
  if (!options.config.empty())
    take_config(command, options.config);
  checked_host result;
  result.config = node.config;
  result.config.skill_dirs = node.skill_dirs;
  result.interface =
      options.interface.empty() ? node.interface : options.interface;
  if (!options.data_dir.empty())
    result.config.data_dir = fs::absolute(options.data_dir);
  return result;
}

/// A folder that was named is looked at from here.
bool is_named(const doctor_options& options, const std::string& check) {
  return !options.data_dir.empty()
         && (check == "disk" || check == "fsync" || check == "skills");
}

/// The node's checks, and its own answers to those of its host.
void ask_node(const doctor_options& options, bool here, check_plan& what) {
  const auto reported = what.node->get("/v1/node").get<node_description>();
  if (here) {
    follow_node(what.host, *what.node, reported);
    what.own = reported.identity.name;
    for (auto& x : own_checks(what.node, what.checks))
      if (!is_named(options, x.name))
        *std::find_if(what.checks.begin(), what.checks.end(), [&](auto& y) {
          return std::string_view{y.name} == x.name;
        }) = std::move(x);
  }
  for (auto& x : node_checks(what.node))
    what.checks.push_back(std::move(x));
}

/// A node that does not answer is worth a word where it was named, or where
/// something lies that looks like one.
void print_no_node(const doctor_options& options, const target& where,
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

/// Why a check that was asked for by name is not made.
std::string unmade(const std::string& name) {
  return is_cell_check(name)
             ? "it checks a whole cell: add --cell"
             : "there is no node that can be asked, or it runs on another host";
}

} // namespace

std::string command_of(const doctor_options& options) {
  std::string result = "roscell doctor";
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty())
      result += std::string{" "} + option + " " + shell_word(value);
  };
  add("--to", options.connection.to);
  add("--token-file", options.connection.token_file.string());
  add("--config", options.config.string());
  add("--interface", options.interface);
  add("--data-dir", options.data_dir.string());
  return result;
}

check_plan prepare(const doctor_options& options) {
  check_plan result;
  result.host = host_of(options);
  result.node = std::make_shared<const node_client>(
      connection_to(options, result.host.config));
  const auto& where = result.node->where();
  const bool here = is_here(where);
  if (here)
    result.checks = host_checks();
  else
    result.known.push_back(
        named_finding("host", "host",
                      {judgement::skipped, "the node runs on another host", "",
                       on_host(where.host, "roscell doctor")}));
  try {
    ask_node(options, here, result);
  } catch (const command_error& e) {
    print_no_node(options, where, e, result.known);
  } catch (const std::exception& e) {
    result.known.push_back(named_finding(
        "node", "node", finding_of_failure(e, judgement::broken)));
  }
  if (result.host.config.data_dir.empty())
    result.host.config.data_dir = default_data_dir();
  return result;
}

void keep_only(const std::vector<std::string>& names, bool cell,
               check_plan& what) {
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

} // namespace roscell::cli
