#include "messages/codec/json_codec.hpp"
#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/builtins/builtins.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>

namespace roscell::cli {

namespace {

/// Longer than a coordinator waits for another node.
constexpr std::chrono::seconds tree_limit{30};

struct tree_options {
  std::string node; ///< Empty: the one that is asked.
  std::string output = "table";
};

int show_tree(const tree_options& options) {
  node_query query;
  query.actors = true;
  query.node = options.node;
  const auto reply = node_client{{}}.ask(message_json(query), tree_limit);
  if (options.output == "json") {
    print(pretty(reply.at("actors")));
    return exit_done;
  }
  const auto node = reply.get<node_description>();
  print(printable(node.identity.name) + ", " + role_text(node.role)
        + (node.cell.empty() ? "" : " in cell " + printable(node.cell)) + "\n\n"
        + actors_view(node.actors, view_style_now()));
  return exit_done;
}

} // namespace

void add_tree_builtin(CLI::App& app, action& chosen) {
  auto options = std::make_shared<tree_options>();
  auto* word = app.add_subcommand(
      "tree",
      "Show the tree of actors of a node: what waits for them, and their "
      "time.");
  word->group(own_announcement);
  word->footer("Another node of the cell is asked by its coordinator.\n\n"
               "Examples:\n  tree\n  tree arm-1\n  tree -o json");
  word->add_option("NODE", options->node, "A node of the cell; none: this one")
      ->option_text(" ");
  add_output_option(*word, options->output);
  word->callback([&chosen, options] {
    chosen = [options] { return show_tree(*options); };
  });
}

} // namespace roscell::cli
