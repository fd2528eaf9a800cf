#include "messages/site.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>
#include <string>

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds audit_limit{15};
constexpr int64_t newest_by_default = 50;

struct audit_options {
  connection_options connection;
  int64_t newest = newest_by_default;
  std::string node;
  std::string output = "table";
};

table audit_table_of(const audit_list& known, int64_t now_unix_ms) {
  table result;
  result.columns = {{"NUMBER"},  {"AGE"},     {"FROM"},
                    {"REQUEST"}, {"SUBJECT"}, {"OUTCOME"}};
  for (const auto& x : known.records)
    result.rows.push_back({std::to_string(x.number),
                           format_since(x.unix_ms, now_unix_ms), x.from,
                           x.request, x.subject, x.outcome});
  return result;
}

int show_audit(const audit_options& options) {
  const node_client node{options.connection};
  audit_query what;
  what.newest = options.newest;
  what.node = options.node;
  const auto reply = node.ask(message_json(what), audit_limit);
  const auto known = reply.get<audit_list>();
  const auto style = view_style_now();
  if (options.output == "json")
    print(pretty(reply));
  else
    print(audit_table_of(known, style.now_unix_ms).render(style.text));
  if (known.gap.empty())
    return exit_done;
  throw command_error{
      exit_refused, "the records do not fit together: " + printable(known.gap),
      "somebody who may write the node's data directory has "
      "changed them, or its disk has lost some"};
}

} // namespace

void add_audit_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<audit_options>();
  auto* command = app.add_subcommand(
      "audit", "List who has changed what, and whether that list is whole.");
  command->footer("Each node writes down what it was asked itself.\n\n"
                  "Examples:\n  roscell audit\n"
                  "  roscell audit --newest 500 -o json --to 10.0.0.1");
  command
      ->add_option("--newest", options->newest, "At most so many, the newest")
      ->check(CLI::Range(1, 1000))
      ->option_text("N [50]");
  command
      ->add_option("--node", options->node,
                   "Of the cell, in place of the one that is asked")
      ->option_text("NODE");
  add_output_option(*command, options->output);
  add_connection_options(*command, options->connection);
  command->callback([&chosen, options] {
    chosen = [options] { return show_audit(*options); };
  });
}

} // namespace roscell::cli
