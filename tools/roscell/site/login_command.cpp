#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/http/client/site_door.hpp"
#include "actors/edge/trust/limits.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

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
    if (const auto failed = keep_identity(file, got))
      throw command_error{exit_refused, failed->message, failed->hint};
    print_note("--to " + printable(address) + " asks as "
               + printable(text_of(got.own.who())) + ", by '"
               + printable(file.string()) + "'");
  }
  return exit_done;
}

} // namespace

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
