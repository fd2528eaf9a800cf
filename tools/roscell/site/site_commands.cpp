#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/trust/site_folder.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

namespace fs = std::filesystem;

struct site_options {
  fs::path folder;
  std::string name;
  std::string role;
  std::string uuid;
  fs::path out;
  std::string output = "table";
};

using site_options_ptr = std::shared_ptr<site_options>;

int64_t unix_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

fs::path folder_of(const site_options& options) {
  return options.folder.empty() ? default_data_dir() / "site" : options.folder;
}

template <class T>
T unless_failed(edge_result<T> result) {
  if (const auto* why = std::get_if<edge_error>(&result))
    throw command_error{exit_usage, why->message, why->hint};
  return std::get<T>(std::move(result));
}

site_folder open_site(const site_options& options) {
  return unless_failed(site_folder::open(folder_of(options)));
}

int create_site(const site_options& options) {
  const auto folder = folder_of(options);
  const auto made =
      unless_failed(site_folder::create(folder, options.name, unix_now_s()));
  print_note("site '" + printable(options.name) + "' is in "
             + printable(folder.string())
             + ": whoever has its site.key makes identities of it, so keep a "
               "copy where nobody else comes");
  print_note("its certificate has the digest " + made.site().digest());
  return exit_done;
}

int issue_identity(const site_options& options) {
  const auto role = role_from(options.role);
  auto site = open_site(options);
  const identity who{site.site().site(), *role, options.name,
                     options.uuid.empty() ? make_uuid() : options.uuid};
  if (const auto read = identity_in(uri_of(who)); !read || !(*read == who))
    throw command_error{
        exit_usage,
        "an identity cannot be of '" + printable(options.name)
            + "' with the UUID '" + printable(who.uuid) + "'",
        "a name has 1 to 63 letters, digits, '_', '.' or '-', the first a "
        "letter or digit; a UUID 1 to 64 hexadecimal digits or '-'"};
  const auto file =
      options.out.empty() ? fs::path{options.name + ".pem"} : options.out;
  std::error_code ignored;
  if (fs::exists(file, ignored))
    throw command_error{exit_usage,
                        "'" + printable(file.string()) + "' is there already",
                        "--out names another file"};
  const auto made =
      unless_failed(site.issue(who, unix_now_s(), good_for_of(*role)));
  // Its owner alone can read it.
  if (const auto why = write_lasting(file, text_of(made)); !why.empty())
    throw command_error{exit_refused, why,
                        "it was made, and is in no file: revoke it"};
  print_note("'" + printable(file.string()) + "' is the identity of "
             + printable(text_of(who))
             + ", with its key: give it to no other, and remove it here");
  return exit_done;
}

std::string state_of(const site_folder& site, const issued_certificate& x) {
  if (site.revoked().contains(x.serial))
    return "revoked";
  return x.ends_unix_s < unix_now_s() ? "ended" : "good";
}

nlohmann::json document_of(const site_folder& site) {
  auto rows = nlohmann::json::array();
  for (const auto& x : site.issued())
    rows.push_back({{"role", to_word(x.who.role)},
                    {"name", x.who.name},
                    {"uuid", x.who.uuid},
                    {"serial", x.serial},
                    {"ends_unix_s", x.ends_unix_s},
                    {"state", state_of(site, x)}});
  return {{"site", site.site().site()},
          {"digest", site.site().digest()},
          {"revocations", site.revoked().number()},
          {"identities", std::move(rows)}};
}

int list_site(const site_options& options) {
  const auto site = open_site(options);
  if (options.output == "json") {
    print(pretty(document_of(site)));
    return exit_done;
  }
  table result;
  result.columns = {{"ROLE"}, {"NAME"}, {"UUID"}, {"STATE"}, {"SERIAL"}};
  for (const auto& x : site.issued())
    result.rows.push_back({to_word(x.who.role), x.who.name, x.who.uuid,
                           state_of(site, x), x.serial});
  print(result.render(view_style_now().text));
  return exit_done;
}

/// All that is meant: a serial names one, a name whatever has it.
std::vector<issued_certificate> find_issued(const site_folder& site,
                                            const std::string& word) {
  std::vector<issued_certificate> result;
  for (const auto& x : site.issued())
    if ((x.serial == word || x.who.name == word || x.who.uuid == word)
        && !site.revoked().contains(x.serial))
      result.push_back(x);
  return result;
}

int revoke_identity(const site_options& options) {
  auto site = open_site(options);
  const auto meant = find_issued(site, options.name);
  if (meant.empty())
    throw command_error{exit_usage,
                        "no identity of '" + printable(options.name)
                            + "' counts at site '"
                            + printable(site.site().site()) + "'",
                        "`roscell site list` shows all"};
  for (const auto& x : meant) {
    if (const auto why = site.revoke(x, unix_now_s()))
      throw command_error{exit_refused, why->message, why->hint};
    print_note("the certificate " + x.serial + " of "
               + printable(text_of(x.who)) + " counts no more");
  }
  print_note("copy '" + printable((folder_of(options) / "revoked").string())
             + "' beside the identity of each node, as IDENTITY_FILE.revoked: "
               "it counts there from the next handshake");
  return exit_done;
}

std::string names_a_role(const std::string& text) {
  const auto role = role_from(text);
  return role && *role != site_role::issuer
             ? std::string{}
             : "give node, coordinator, operator or viewer";
}

/// A command below `site`, with the option that all of them have.
CLI::App* add_command(CLI::App& site, const site_options_ptr& options,
                      const char* name, const char* what) {
  auto* command = site.add_subcommand(name, what);
  command
      ->add_option("--dir", options->folder,
                   "Where the site is kept, with its key")
      ->option_text("DIR [DATA_DIR/site]");
  return command;
}

void run_by(CLI::App& command, action& chosen, const site_options_ptr& options,
            int (*run)(const site_options&)) {
  command.callback([&chosen, options, run] {
    chosen = [options, run] { return run(*options); };
  });
}

void add_making(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* create = add_command(site, options, "create",
                             "Make a site: a key that identities are made by.");
  create->footer("Examples:\n  roscell site create hall");
  create->add_option("SITE", options->name, "Its name")
      ->required()
      ->option_text(" ");
  run_by(*create, chosen, options, create_site);
}

void add_issuing(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* issue =
      add_command(site, options, "issue",
                  "Make the identity of a node, a coordinator or a person.");
  issue->footer("Examples:\n  roscell site issue coordinator head\n"
                "  roscell site issue node arm --uuid 0d3c... --out arm.pem\n"
                "  roscell site issue viewer wall");
  issue
      ->add_option("ROLE", options->role, "node, coordinator, operator, viewer")
      ->required()
      ->check(CLI::Validator{names_a_role, "ROLE"})
      ->option_text(" ");
  issue->add_option("NAME", options->name, "Of the node or the person")
      ->required()
      ->option_text(" ");
  issue
      ->add_option("--uuid", options->uuid,
                   "Of a node that has been there before")
      ->option_text("UUID [a new one]");
  issue->add_option("--out", options->out, "Where to write it")
      ->option_text("FILE [NAME.pem]");
  run_by(*issue, chosen, options, issue_identity);
}

void add_looking(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* list =
      add_command(site, options, "list", "List the identities that were made.");
  list->footer("Examples:\n  roscell site list -o json");
  add_output_option(*list, options->output);
  run_by(*list, chosen, options, list_site);
}

void add_revoking(CLI::App& site, action& chosen) {
  auto options = std::make_shared<site_options>();
  auto* revoke =
      add_command(site, options, "revoke", "Have identities count no more.");
  revoke->footer("Examples:\n  roscell site revoke arm");
  revoke->add_option("WHO", options->name, "A name, a UUID or a serial")
      ->required()
      ->option_text(" ");
  run_by(*revoke, chosen, options, revoke_identity);
}

} // namespace

void add_site_command(CLI::App& app, action& chosen) {
  auto* site = app.add_subcommand(
      "site", "A site of identities: who is a node, a coordinator, a person.");
  site->require_subcommand(1);
  add_making(*site, chosen);
  add_issuing(*site, chosen);
  add_looking(*site, chosen);
  add_revoking(*site, chosen);
}

} // namespace roscell::cli
