#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/http/client/site_door.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/sealed_text.hpp"
#include "messages/site.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <system_error>
#include <utility>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

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
  const auto uuid = make_uuid();
  const auto issue = [&](site_role as) {
    return unless_failed(
        site.issue({site.site().site(), as, options.name, uuid}, unix_now_s(),
                   good_for_of(as)));
  };
  const auto own = issue(role);
  if (role != site_role::coordinator)
    return to_hex(seal_text(secret, deposit_of(own, nullptr)));
  const auto issuing = issue(site_role::issuer);
  return to_hex(seal_text(secret, deposit_of(own, &issuing)));
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

/// By what the invitation was kept for: his own name is in it already.
constexpr const char* person = "person";

std::string text_of_line(const std::string& given) {
  std::error_code ignored;
  if (!fs::exists(given, ignored))
    return given;
  return read_small_file(given, limits::trust::invitation_bytes).value_or("");
}

int login(const std::string& line, const std::string& host) {
  std::string why;
  auto by = read_invitation(text_of_line(line), why);
  if (!by)
    throw command_error{exit_usage, why,
                        "--invite takes the line that `roscell site invite` "
                        "prints, or the name of a file with it"};
  if (!host.empty())
    by->addresses = {parse_target(host).text()};
  const auto got = unless_failed(enter_site(*by, {person, make_uuid()}));
  const auto role = got.own.who().role;
  if (role != site_role::operating && role != site_role::viewer)
    throw command_error{exit_refused,
                        "the invitation was for a " + std::string{to_word(role)}
                            + ", and is used up now",
                        "`roscell site invite operator NAME` invites a person"};
  for (const auto& address : by->addresses) {
    const auto file = login_file_of(parse_target(address));
    std::error_code problem;
    fs::create_directories(file.parent_path(), problem);
    if (const auto failed = keep_identity(file, got.own, {}, got.revoked))
      throw command_error{exit_refused, failed->message, failed->hint};
    print_note("--to " + printable(address) + " asks as "
               + printable(text_of(got.own.who())) + ", by '"
               + printable(file.string()) + "'");
  }
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

void add_login_command(CLI::App& app, action& chosen) {
  auto line = std::make_shared<std::string>();
  auto host = std::make_shared<std::string>();
  auto* command = app.add_subcommand(
      "login", "Become an operator or a viewer of a site, by an invitation.");
  command->footer("The identity is kept for this user, and --to uses it.\n\n"
                  "Examples:\n  roscell login --invite roscell1:hall:...\n"
                  "  roscell login 10.0.0.1 --invite anna.invitation");
  command
      ->add_option("HOST", *host,
                   "Coordinator to go to, if the invitation's addresses are "
                   "not as he is seen from here")
      ->option_text(" ");
  command->add_option("--invite", *line, "The line, or a file with it")
      ->required()
      ->option_text("LINE|FILE");
  command->callback([&chosen, line, host] {
    chosen = [line, host] { return login(*line, *host); };
  });
}

} // namespace roscell::cli
