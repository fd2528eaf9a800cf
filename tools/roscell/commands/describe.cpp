#include "messages/instance.hpp"
#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/commands/log_printer.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/describe/describe_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

namespace roscell::cli {

namespace {

constexpr int64_t shown_log_lines = 10;

const std::vector<std::string> kinds{"node", "task", "instance", "skill",
                                     "cell"};

struct describe_options {
  connection_options connection;
  std::vector<std::string> words; ///< [KIND] NAME
  std::string output = "table";

  view_style style() const {
    auto result = view_style_now();
    result.text.tables.wide = output == "wide";
    return result;
  }
};

/// The end of an instance's log; a description without it is one too.
std::string log_of(const node_client& node, const known_thing& what) {
  if (what.kind != thing_kind::instance)
    return {};
  log_query query;
  query.instance = what.name;
  query.tail_lines = shown_log_lines;
  const auto reply =
      node.post("/v1/requests", message_json(query).dump(), log_limit);
  return reply.value("type", "") == log_excerpt::type
             ? reply.get<log_excerpt>().text
             : std::string{};
}

/// A member tells of what is elsewhere by its coordinator.
known_thing find_in_cell(const node_client& node, known_cell& known,
                         const std::string& kind, const std::string& name) {
  try {
    return find_thing(known, kind, name);
  } catch (const command_error& why) {
    if (why.code != exit_refused || !add_cell_of_member(node, known))
      throw;
  }
  return find_thing(known, kind, name);
}

int describe(const describe_options& options) {
  const auto kind = options.words.size() == 2 ? options.words[0] : "";
  if (!kind.empty()
      && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw command_error{exit_usage, "there is no kind '" + kind + "'",
                        "the kinds are node, task, instance, skill and cell"};
  const node_client node{options.connection};
  auto known = ask_for_cell(node);
  const auto what = find_in_cell(node, known, kind, options.words.back());
  const auto log = log_of(node, what);
  print(options.output == "json"
            ? pretty(describe_json(known, what, log))
            : describe_view(known, what, log, options.style()));
  return exit_done;
}

} // namespace

void add_describe_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<describe_options>();
  auto* command = app.add_subcommand(
      "describe", "Describe a node, task, instance, skill or cell.");
  command->footer("KIND is node, task, instance, skill or cell; it can be left "
                  "out if only one thing\nhas the name. Of an instance the "
                  "beginning of its id is enough.\n\nExamples:\n"
                  "  roscell describe node arm-1\n"
                  "  roscell describe fleet-poses\n"
                  "  roscell describe cell lab -o json");
  add_connection_options(*command, options->connection);
  command->add_option("NAME", options->words, "KIND and NAME, or NAME")
      ->required()
      ->expected(1, 2);
  add_wide_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return describe(*options); };
  });
}

} // namespace roscell::cli
