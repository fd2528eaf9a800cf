#include "messages/cell.hpp"
#include "messages/secret.hpp"
#include "schemas/utf8.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/secrets/secret_value.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

namespace {

/// As long as a node's disk may take.
constexpr std::chrono::seconds answer_limit{15};

struct secret_options {
  connection_options connection;
  std::string output = "table";
  std::vector<std::string> names;
  value_origin origin;
  std::string node;  ///< Of the cell; empty: the one that is asked.
  bool cell = false; ///< All of its nodes.
};

using secret_options_ptr = std::shared_ptr<secret_options>;

/// Asked before the value is, so that it is never sent on a way that others can
/// listen to.
void expect_this_host(const node_client& client) {
  const auto& node = client.where();
  const auto& host = node.host;
  if (node.is_local() || client.endpoint().identity || host == "localhost"
      || host == "::1" || host.compare(0, 4, "127.") == 0)
    return;
  throw command_error{exit_usage,
                      "a secret is set on the host of its node only: its value "
                      "would travel in clear to "
                          + printable(node.text()),
                      "run it there: ssh " + printable(host)
                          + " roscell secret set NAME < FILE"};
}

/// Who is away has to be given it later: that is said, and is no success.
int set_in_cell(const node_client& node, secret_setting request) {
  const auto cell = node.get("/v1/cell").get<cell_description>();
  std::string missed;
  size_t given = 0;
  for (const auto& row : cell.nodes)
    try {
      request.node = row.identity.name;
      node.ask(message_json(request), answer_limit);
      ++given;
    } catch (const refused& why) {
      missed += (missed.empty() ? "'" : "; '") + row.identity.name
                + "': " + failure_from(why.reply).message;
    }
  print_note("secret '" + printable(request.name) + "' is set on "
             + std::to_string(given) + " of "
             + std::to_string(cell.nodes.size()) + " nodes of cell '"
             + printable(cell.cell) + "'");
  if (missed.empty())
    return exit_done;
  throw command_error{exit_refused, "not set on " + printable(missed),
                      "set it again once they are there: who has it keeps it"};
}

int set_secret(const secret_options& options) {
  const node_client node{options.connection};
  expect_this_host(node);
  const auto& name = options.names.front();
  secret_setting request{
      name, to_base64(read_secret_value(name, options.origin)), {}};
  if (options.cell)
    return set_in_cell(node, request);
  request.node = options.node;
  const auto reply =
      node.ask(message_json(request), answer_limit).get<secret_set>();
  print_note("secret '" + printable(name) + "' is "
             + (reply.replaced ? "replaced: instances that have it get the new "
                                 "value with their next start"
                               : "set"));
  return exit_done;
}

table secret_table_of(const secret_list& known, int64_t now_unix_ms) {
  table result;
  result.columns = {{"NAME"}, {"SET"}, {"INSTANCES", align::left, 1}};
  for (const auto& x : known.secrets)
    result.rows.push_back({x.name, format_since(x.set_unix_ms, now_unix_ms),
                           joined(x.instances, ", ")});
  return result;
}

int list_secrets(const secret_options& options) {
  const node_client node{options.connection};
  const auto reply = node.get("/v1/secrets");
  const auto style = view_style_now();
  if (options.output == "json")
    print(pretty(reply.at("secrets")));
  else
    print(secret_table_of(reply.get<secret_list>(), style.now_unix_ms)
              .render(style.text));
  return exit_done;
}

int remove_secrets(const secret_options& options) {
  const node_client node{options.connection};
  for (const auto& name : options.names) {
    const auto reply =
        node.ask(message_json(secret_removal{name}), answer_limit)
            .get<secret_removed>();
    print_note("secret '" + printable(name) + "' is removed"
               + (reply.instances.empty()
                      ? std::string{}
                      : "; until they end these have it: "
                            + printable(joined(reply.instances, ", "))));
  }
  return exit_done;
}

void add_secret_setting(CLI::App& secrets, action& chosen) {
  auto options = std::make_shared<secret_options>();
  auto* command = secrets.add_subcommand(
      "set", "Keep a value on this host's node, for steps that name it.");
  command->footer(
      "The value comes from standard input, or from a file; at a "
      "terminal it is "
      "asked for twice, and\nnot shown. It is never an argument, "
      "which all users "
      "of a host can read, and never sent to\nanother host in clear. "
      "Instances get a new "
      "value with their next start.\n\n"
      "Examples:\n  roscell secret set broker-key\n"
      "  roscell secret set broker-key --file key.pem\n"
      "  roscell secret set broker-key --cell --file key.pem\n"
      "  pass show broker | roscell secret set broker-key");
  command->add_option("SECRET", options->names, "Its name, as steps say it")
      ->required()
      ->expected(1)
      ->option_text(" ");
  command
      ->add_option("--file", options->origin.file,
                   "Take these bytes, as they are")
      ->option_text("PATH");
  command
      ->add_option("--node", options->node,
                   "Of the cell whose coordinator is asked, in place of that")
      ->option_text("NODE");
  command->add_flag("--cell", options->cell,
                    "All nodes of the cell whose coordinator is asked");
  command->add_flag("--keep-newline", options->origin.keep_newline,
                    "The line end at the end of standard input is part of it");
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return set_secret(*options); };
  });
}

void add_secret_list(CLI::App& secrets, action& chosen) {
  auto options = std::make_shared<secret_options>();
  auto* command = secrets.add_subcommand(
      "list", "List a node's secrets, without their values.");
  command->footer("Examples:\n  roscell secret list\n"
                  "  roscell secret list --to 192.168.1.10 -o json");
  add_output_option(*command, options->output);
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return list_secrets(*options); };
  });
}

void add_secret_removal(CLI::App& secrets, action& chosen) {
  auto options = std::make_shared<secret_options>();
  auto* command =
      secrets.add_subcommand("remove", "Have a node forget secrets.");
  command->footer("What runs keeps its value until it ends; it does not start "
                  "again without.\n\n"
                  "Examples:\n  roscell secret remove broker-key");
  command->add_option("SECRET", options->names, "Names of secrets")
      ->required()
      ->option_text("...");
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return remove_secrets(*options); };
  });
}

} // namespace

void add_secret_command(CLI::App& app, action& chosen) {
  auto* secrets = app.add_subcommand(
      "secret", "Secrets of a node: values for steps that nobody is told.");
  secrets->require_subcommand(1);
  add_secret_setting(*secrets, chosen);
  add_secret_list(*secrets, chosen);
  add_secret_removal(*secrets, chosen);
}

} // namespace roscell::cli
