#include "actors/edge/trust/identity_place.hpp"
#include "actors/edge/trust/limits.hpp"
#include "tools/roscell/client/target.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/site/site_options.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace roscell::cli {

namespace fs = std::filesystem;

int64_t unix_now_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

fs::path folder_of(const site_options& options) {
  return options.folder.empty() ? default_data_dir() / "site" : options.folder;
}

void give_up_site(const edge_error& why) {
  throw command_error{exit_usage, why.message, why.hint};
}

site_folder open_site(const site_options& options) {
  return unless_failed(site_folder::open(folder_of(options)));
}

cell_description cell_at(const node_client& node) {
  auto cell = node.get("/v1/cell").get<cell_description>();
  std::stable_sort(cell.nodes.begin(), cell.nodes.end(),
                   [&](const auto& a, const auto& b) {
                     return a.identity.name != cell.coordinator
                            && b.identity.name == cell.coordinator;
                   });
  return cell;
}

std::string names_a_role(const std::string& text) {
  const auto role = role_from(text);
  return role && *role != site_role::issuer
             ? std::string{}
             : "give node, coordinator, operator or viewer";
}

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

namespace {

std::string names_a_span(const std::string& text) {
  try {
    parse_span(text);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
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
  const auto good_for = options.good_for.empty()
                            ? good_for_of(*role)
                            : parse_span(options.good_for).count();
  const auto made = unless_failed(site.issue(who, unix_now_s(), good_for));
  // Its owner alone can read it.
  if (const auto why = keep_identity(file, made))
    throw command_error{exit_refused, why->message,
                        "it was made, and is in no file: revoke it"};
  print_note("'" + printable(file.string()) + "' is the identity of "
             + printable(text_of(who))
             + ", with its key: give it to no other, and remove it here");
  return exit_done;
}

std::string state_of(const site_folder& site, const issued_certificate& x) {
  if (site.is_revoked(x))
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
  issue->add_option("--good-for", options->good_for, "How long it counts")
      ->check(CLI::Validator{names_a_span, "SPAN"})
      ->option_text("SPAN [180d; of people 366d]");
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

} // namespace

void add_site_command(CLI::App& app, action& chosen) {
  auto* site = app.add_subcommand(
      "site", "A site of identities: who is a node, a coordinator, a person.");
  site->require_subcommand(1);
  add_making(*site, chosen);
  add_issuing(*site, chosen);
  add_inviting(*site, chosen);
  add_adopting(*site, chosen);
  add_looking(*site, chosen);
  add_revoking(*site, chosen);
}

} // namespace roscell::cli
