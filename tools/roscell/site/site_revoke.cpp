#include "actors/edge/trust/site_folder.hpp"
#include "messages/cell.hpp"
#include "messages/site.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

/// By UUID: whom a coordinator has made identities for, as its site keeper
/// shows it.
std::map<std::string, std::string> issued_in(const json& reply) {
  std::map<std::string, std::string> result;
  const auto actors = reply.value("actors", json::array());
  for (const auto& actor : actors) {
    const auto state = actor.value("state", json::object());
    const auto issued = state.value("issued", json::object());
    for (const auto& [uuid, name] : issued.items())
      if (name.is_string())
        result[uuid] = name.get<std::string>();
  }
  return result;
}

/// UUIDs of those in a cell, or away from it, that are called so; empty: there
/// is nobody, or no cell to ask, which is said when the list is passed on.
std::vector<std::string> uuids_in_cell(const site_options& options,
                                       const std::string& name) {
  std::vector<std::string> result;
  try {
    const node_client node{options.connection};
    for (const auto& row : cell_at(node).nodes)
      if (row.identity.name == name)
        result.push_back(row.identity.uuid);
    // Who is away is in no cell now.
    const auto keeper = node.get("/v1/actors/site-keeper");
    for (const auto& [uuid, called] : issued_in(keeper))
      if (called == name || uuid == name)
        result.push_back(uuid);
  } catch (const std::runtime_error&) {
    return result;
  }
  return result;
}

/// Gives the list of the revoked to the coordinator and his cell, as far as
/// they can be reached, and says who was not.
void pass_list_on(const site_options& options, const site_folder& site) {
  const auto list = site.signed_list();
  std::string missed;
  try {
    const node_client node{options.connection};
    auto nodes = cell_at(node).nodes;
    // Whom all others ask knows it first.
    std::reverse(nodes.begin(), nodes.end());
    for (const auto& row : nodes)
      try {
        node.ask(message_json(revocation_setting{row.identity.name, list}),
                 site_answer_limit);
      } catch (const refused&) {
        missed += (missed.empty() ? "'" : ", '") + row.identity.name + "'";
      }
    print_note("the cell knows"
               + (missed.empty() ? std::string{}
                                 : ", but for " + printable(missed)
                                       + ", which hears it when it is back"));
  } catch (const std::runtime_error& why) {
    print_note("no cell was told (" + printable(why.what())
               + "): --to names its coordinator, or copy '"
               + printable((folder_of(options) / "revoked").string())
               + "' beside the identity of each node, as "
                 "IDENTITY_FILE.revoked");
  }
}

/// Certificates are made by the clocks of coordinators, which may be ahead.
constexpr int64_t clock_margin_s = 60;

const issued_certificate* find_serial(const site_folder& site,
                                      const std::string& serial) {
  for (const auto& x : site.issued())
    if (x.serial == serial)
      return &x;
  return nullptr;
}

/// Of all that are called so: here, and in the cell, whose coordinators make
/// identities, too.
std::set<std::string> find_owners(const site_options& options,
                                  const site_folder& site) {
  std::set<std::string> result;
  for (const auto& x : site.issued())
    if ((x.who.name == options.name || x.who.uuid == options.name)
        && !site.is_revoked(x))
      result.insert(x.who.uuid);
  for (const auto& uuid : uuids_in_cell(options, options.name))
    result.insert(uuid);
  return result;
}

bool makes_identities(const site_folder& site, const std::string& uuid) {
  return std::any_of(site.issued().begin(), site.issued().end(),
                     [&](const issued_certificate& x) {
                       return x.who.uuid == uuid
                              && x.who.role == site_role::issuer;
                     });
}

int revoke_identity(const site_options& options) {
  auto site = open_site(options);
  const auto refuse = [](std::optional<edge_error> why) {
    if (why)
      throw command_error{exit_refused, why->message, why->hint};
  };
  const auto* one = find_serial(site, options.name);
  if (one != nullptr) {
    refuse(site.revoke(issued_certificate{*one}, unix_now_s()));
    print_note("the certificate " + one->serial + " of "
               + printable(text_of(one->who)) + " counts no more");
    pass_list_on(options, site);
    return exit_done;
  }
  const auto owners = find_owners(options, site);
  if (owners.empty())
    throw command_error{exit_usage,
                        "no identity of '" + printable(options.name)
                            + "' counts at site '"
                            + printable(site.site().site()) + "'",
                        "`roscell site list` shows what was made here, and "
                        "--to names the cell that it is in"};
  for (const auto& uuid : owners) {
    refuse(site.revoke_owner(uuid, unix_now_s() + clock_margin_s));
    print_note("what '" + printable(options.name) + "' with UUID "
               + printable(uuid) + " had counts no more"
               + (makes_identities(site, uuid)
                      ? ", nor what it has made for nodes: invite them again "
                        "by another coordinator"
                      : ""));
  }
  pass_list_on(options, site);
  return exit_done;
}

} // namespace

void add_revoking(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* revoke =
      add_command(site, options, "revoke", "Have identities count no more.");
  revoke->footer("Examples:\n  roscell site revoke arm");
  revoke->add_option("WHO", options->name, "A name, a UUID or a serial")
      ->required()
      ->option_text(" ");
  add_connection_options(*revoke, options->connection);
  run_by(*revoke, chosen, options, revoke_identity);
}

} // namespace roscell::cli
