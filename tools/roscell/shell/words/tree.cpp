#include "messages/cell.hpp"
#include "messages/failure.hpp"
#include "messages/node.hpp"
#include "schemas/closest_word.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/words/words.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

namespace roscell::cli {

namespace {

constexpr auto actors_path = "/v1/node?actors=1";

struct tree_options {
  std::string node; ///< Empty: the one that is asked.
  std::filesystem::path token_file;
  std::string output = "table";
};

/// Where a node of the cell answers, as the cell knows it.
std::string address_in(const cell_description& cell, const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& row : cell.nodes) {
    if (row.identity.name == name)
      return row.identity.address;
    names.push_back(row.identity.name);
  }
  const auto meant = closest_word(name, names);
  throw command_error{exit_usage, "the cell has no node '" + name + "'",
                      meant.empty()
                          ? "`nodes` lists them"
                          : "did you mean " + std::string{meant} + "?"};
}

/// The answer of another node, which has a token of its own.
json ask_other(const tree_options& options, const std::string& address) {
  // What opens the node that the shell speaks to must not come to another one.
  unsetenv("ROSCELL_TOKEN");
  const auto who = "node '" + options.node + "' at " + address;
  try {
    return node_client{{address, options.token_file}}.get(actors_path);
  } catch (const refused& e) {
    const auto why = failure_from(e.reply);
    throw command_error{
        exit_refused, who + " refuses: " + why.message,
        "copy `token` of its data directory here and say `tree " + options.node
            + " --token-file FILE`, or ask on its own host: `roscell shell -c "
              "tree`"};
  } catch (const command_error& e) {
    throw command_error{e.code, who + " cannot be asked: " + e.what(),
                        "let its TCP port through, or ask on its own host: "
                        "`roscell shell -c tree`"};
  }
}

json ask_for_actors(const tree_options& options) {
  const node_client asked{{}};
  auto own = asked.get(actors_path);
  if (options.node.empty() || options.node == own.at("identity").at("name"))
    return own;
  const auto cell = asked.get("/v1/cell").get<cell_description>();
  return ask_other(options, address_in(cell, options.node));
}

int show_tree(const tree_options& options) {
  const auto reply = ask_for_actors(options);
  if (options.output == "json") {
    print(pretty(reply.at("actors")));
    return exit_done;
  }
  const auto node = reply.get<node_description>();
  print(node.identity.name + ", " + to_string(node.role)
        + (node.cell.empty() ? "" : " in cell " + node.cell) + "\n\n"
        + actors_view(node.actors, view_style_now()));
  return exit_done;
}

} // namespace

void add_tree_word(CLI::App& app, action& chosen) {
  auto options = std::make_shared<tree_options>();
  auto* word = app.add_subcommand(
      "tree",
      "Show the actors of a node: what waits for them, and their time.");
  word->group(own_words);
  word->footer("Another node of the cell is asked at its own address, over TCP "
               "and with its own token.\n\n"
               "Examples:\n  tree\n  tree arm-1 --token-file arm-1.token\n"
               "  tree -o json");
  word->add_option("NODE", options->node, "A node of the cell; none: this one")
      ->option_text(" ");
  word->add_option("--token-file", options->token_file,
                   "Bearer token of NODE. Default, for an address of this "
                   "machine: its node's token")
      ->option_text("FILE");
  add_output_option(*word, options->output);
  word->callback([&chosen, options] {
    chosen = [options] { return show_tree(*options); };
  });
}

} // namespace roscell::cli
