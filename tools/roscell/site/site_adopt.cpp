#include "actors/edge/disk/data_folder.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/limits.hpp"
#include "messages/cell.hpp"
#include "messages/site.hpp"
#include "schemas/document.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <system_error>
#include <utility>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// As long as one does not answer, nothing of any is changed.
std::vector<identity_requested> ask_all(const site_options& options,
                                        const node_client& node,
                                        const cell_description& cell) {
  std::vector<identity_requested> result;
  std::string silent;
  for (const auto& row : cell.nodes) {
    const auto& name = row.identity.name;
    if (holds(options.without, name))
      continue;
    try {
      result.push_back(node.ask(message_json(identity_request_query{name}),
                                site_answer_limit)
                           .get<identity_requested>());
    } catch (const refused& why) {
      silent += (silent.empty() ? "'" : ", '") + name
                + "': " + failure_from(why.reply).message;
    }
  }
  if (!silent.empty())
    throw command_error{exit_refused,
                        "nothing has changed, since not all of cell '"
                            + printable(cell.cell)
                            + "' answer: " + printable(silent),
                        "wait for them, or leave them out with --without "
                        "NODE, and invite them later"};
  return result;
}

certificate certify(site_folder& site, const identity_requested& x,
                    site_role role, const std::string& request) {
  const auto key = key_in_request(from_hex(request).value_or(""));
  if (!key)
    throw command_error{exit_refused, "node '" + printable(x.node)
                                          + "' asks for no certificate that "
                                            "could be made"};
  return unless_failed(site.certify({site.site().site(), role, x.node, x.uuid},
                                    key.get(), unix_now_s(),
                                    good_for_of(role)));
}

identity_set give_identity(const node_client& node, site_folder& site,
                           const identity_requested& x) {
  identity_setting what;
  what.node = x.node;
  what.chain =
      certify(site, x, x.coordinator ? site_role::coordinator : site_role::node,
              x.request)
          .pem();
  if (x.coordinator)
    what.issuing = certify(site, x, site_role::issuer, x.issuing).pem();
  what.site = site.site().pem();
  what.revoked = site.signed_list();
  return node.ask(message_json(what), site_answer_limit).get<identity_set>();
}

/// Certificates of theirs that have more than half of their time are let be.
void leave_out_fresh(const node_client& node,
                     std::vector<identity_requested>& all) {
  const auto is_fresh = [&](const identity_requested& x) {
    const auto at =
        node.ask(message_json(site_query{x.node}), site_answer_limit)
            .get<site_status>();
    const auto role = x.coordinator ? site_role::coordinator : site_role::node;
    return at.ends_unix_s - unix_now_s() > good_for_of(role) / 2;
  };
  all.erase(std::remove_if(all.begin(), all.end(), is_fresh), all.end());
}

int give_all(const node_client& node, site_folder& site,
             const std::vector<identity_requested>& all) {
  for (const auto& x : all) {
    const auto set = give_identity(node, site, x);
    print_note("node '" + printable(x.node) + "' is " + printable(set.identity)
               + ", for "
               + std::to_string((set.ends_unix_s - unix_now_s())
                                / limits::trust::day_s)
               + " days"
               + (set.later ? ", once it has started anew by itself" : ""));
  }
  return exit_done;
}

int adopt(const site_options& options) {
  auto site = open_site(options);
  const node_client node{options.connection};
  const auto cell = cell_at(node);
  const auto all = ask_all(options, node, cell);
  give_all(node, site, all);
  print_note("cell '" + printable(cell.cell) + "' is of the site '"
             + printable(site.site().site())
             + "': " + std::to_string(all.size())
             + " nodes; tokens count no more for them. `roscell cell` shows "
               "when all are back, within some seconds");
  for (const auto& x : cell.free)
    print_note("node '" + printable(x.name)
               + "' is in no cell, and so has no identity: invite it");
  return exit_done;
}

int renew(const site_options& options) {
  auto site = open_site(options);
  const node_client node{options.connection};
  const auto cell = cell_at(node);
  auto all = ask_all(options, node, cell);
  if (!options.all)
    leave_out_fresh(node, all);
  give_all(node, site, all);
  if (all.empty())
    print_note("all certificates have more than half of their time: --all "
               "renews them anyhow");
  return exit_done;
}

/// The new site stands beside the old one until all have taken it.
int rotate(const site_options& options) {
  const auto folder = folder_of(options);
  auto next = folder;
  next += ".next";
  const auto name = open_site(options).site().site();
  std::error_code problem;
  if (!fs::exists(next / "site.pem", problem))
    unless_failed(site_folder::create(next, name, unix_now_s()));
  auto moved = options;
  moved.folder = next;
  adopt(moved);
  // A former one stays: whoever has stolen its key is known by it.
  const auto former = unless_failed(put_aside(folder));
  fs::rename(next, folder, problem);
  if (problem)
    throw command_error{exit_refused,
                        "the new site stays in '" + printable(next.string())
                            + "': " + problem.message(),
                        "put it in place of '" + printable(folder.string())
                            + "'"};
  print_note("the site has another key. What it had is in '"
             + printable(former.string())
             + "'; people, and nodes that were away, need another invitation");
  return exit_done;
}

/// What these commands have in common.
CLI::App* add_for_cell(CLI::App& site, action& chosen,
                       const site_options_ptr& options, const char* name,
                       const char* what, int (*run)(const site_options&)) {
  auto* command = add_command(site, options, name, what);
  command->add_option("--without", options->without, "Leave that node as it is")
      ->allow_extra_args(false)
      ->option_text("NODE...");
  add_connection_options(*command, options->connection);
  run_by(*command, chosen, options, run);
  return command;
}

} // namespace

void add_adopting(CLI::App& site, action& chosen) {
  add_for_cell(site, chosen, std::make_shared<site_options>(), "adopt",
               "Give all nodes of a cell that has a token identities.", adopt)
      ->footer("No instance is restarted. Nodes that do not answer keep the "
               "whole cell as it is.\n\n"
               "Examples:\n  roscell site adopt\n"
               "  roscell site adopt --to 10.0.0.1 --without old-arm");
  const auto renewing = std::make_shared<site_options>();
  auto* command =
      add_for_cell(site, chosen, renewing, "renew",
                   "Renew the certificates of a cell's coordinators, and of "
                   "its nodes, which else renew themselves.",
                   renew);
  command->footer(
      "Examples:\n  roscell site renew\n  roscell site renew --all");
  command->add_flag("--all", renewing->all,
                    "Also those that have more than half of their time");
  add_for_cell(site, chosen, std::make_shared<site_options>(), "rotate",
               "Give the site another key, and a cell identities of it, where "
               "the old key was lost or stolen.",
               rotate)
      ->footer("Examples:\n  roscell site rotate");
}

} // namespace roscell::cli
