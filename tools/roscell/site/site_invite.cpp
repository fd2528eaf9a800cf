#include "actors/edge/http/client/site_door.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/sealed_text.hpp"
#include "messages/site.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <utility>

namespace roscell::cli {

namespace {

constexpr size_t secret_bytes = 16;

/// Made here, where the site's key is, and sealed: who keeps it cannot use it.
std::string make_deposit(const site_options& options,
                         const std::string& secret) {
  const auto role = *role_from(options.role);
  if (options.name.empty())
    throw command_error{exit_usage,
                        "whom is the role '" + options.role + "' for?",
                        "roscell site invite " + options.role + " NAME"};
  auto site = open_site(options);
  const auto made = unless_failed(
      site.issue({site.site().site(), role, options.name, make_uuid()},
                 unix_now_s(), good_for_of(role)));
  return to_hex(seal_text(secret, deposit_of(made)));
}

int invite(const site_options& options) {
  const auto secret = to_hex(random_bytes(secret_bytes));
  const bool is_node = options.role == to_word(site_role::node);
  site_invitation what;
  what.node = is_node ? options.name : std::string{};
  what.role = options.role;
  what.secret = proving_half(secret);
  // Before that an identity would be made that nobody can fetch.
  const node_client node{options.connection};
  node.ask(message_json(site_query{}), site_answer_limit);
  if (!is_node)
    what.deposit = make_deposit(options, secret);
  const auto kept =
      node.ask(message_json(what), site_answer_limit).get<site_invited>();
  print(line_of({kept.site, kept.digest.substr(0, invitation_digits),
                 kept.addresses, secret})
        + "\n");
  const bool is_machine =
      is_node || options.role == to_word(site_role::coordinator);
  print_note(std::string{"good once, for a day, for whoever has it: "}
             + (is_machine ? "`roscell node --invite LINE`"
                           : "`roscell login --invite LINE`")
             + " there; a file with the line will do");
  return exit_done;
}

} // namespace

void add_inviting(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* command = add_command(
      site, options, "invite",
      "Let somebody in: a line by which a node or a person gets an identity.");
  command->footer(
      "Of a node, a coordinator makes the identity when the line is used. Of "
      "others it is made\nhere, where the site's key is, and waits at the "
      "coordinator, sealed.\n\nExamples:\n  roscell site invite\n"
      "  roscell site invite node arm --to 10.0.0.1\n"
      "  roscell site invite operator anna > anna.invitation");
  command
      ->add_option("ROLE", options->role, "node, coordinator, operator, viewer")
      ->check(CLI::Validator{names_a_role, "ROLE"})
      ->option_text("[node]");
  command
      ->add_option("NAME", options->name,
                   "Of the node or the person; a node may have any without")
      ->option_text(" ");
  add_connection_options(*command, options->connection);
  run_by(*command, chosen, options, invite);
}

} // namespace roscell::cli
