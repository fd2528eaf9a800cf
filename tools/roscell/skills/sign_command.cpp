#include "actors/builds/limits.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/edge/trust/skill_signature.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/skills/cell_skills.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace roscell::cli {

namespace {

struct sign_options {
  connection_options connection;
  std::string source; ///< A folder, or an archive.
};

int sign_skill(const sign_options& options) {
  const auto to = options.connection.to.empty()
                      ? default_target()
                      : parse_target(options.connection.to);
  const auto own = find_identity(options.connection.identity_file, to);
  if (!own)
    throw command_error{exit_usage, "who signs it?",
                        "--identity names the identity of an operator, or --to "
                        "a coordinator that you have logged in at"};
  if (own->who().role != site_role::operating)
    throw command_error{exit_usage,
                        "operators sign skills, and this is "
                            + printable(text_of(own->who())),
                        "`roscell site invite operator NAME` makes one"};
  const auto hash = build_hash_of(options.source);
  const auto file = signature_file_of(options.source);
  if (const auto why = write_lasting(file, sign_build(own->own(), hash));
      !why.empty())
    throw command_error{exit_refused, why};
  print_note("build " + hash.substr(0, limits::build::shown_digits)
             + " is signed by " + printable(text_of(own->who())) + ", in '"
             + printable(file.string()) + "'");
  return exit_done;
}

} // namespace

void add_skill_sign_command(CLI::App& skills, action& chosen) {
  auto options = std::make_shared<sign_options>();
  auto* command = skills.add_subcommand(
      "sign", "Sign a skill, for cells that take no others.");
  command->footer("The signature lies beside the skill, as NAME.signature, and "
                  "`roscell skill add` sends it along.\n\n"
                  "Examples:\n  roscell skill sign shout-1.2.tar.gz --identity "
                  "anna.pem\n  roscell skill sign build/skills/shout --to "
                  "10.0.0.1");
  command
      ->add_option("FOLDER|ARCHIVE", options->source,
                   "The ready skill, as for `roscell skill add`")
      ->required()
      ->option_text(" ");
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return sign_skill(*options); };
  });
}

} // namespace roscell::cli
