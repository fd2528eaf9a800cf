#include "messages/insight/node_cost.hpp"
#include "tools/roscell/commands/show.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/insight/insight_views.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>

namespace roscell::cli {

namespace {

/// Nodes that give no answer are waited for by their coordinator, and that one
/// by a member, not longer than this.
constexpr std::chrono::seconds cost_limit{30};

int show_status(const show_options& options) {
  const node_client node{options.connection};
  const auto view = [&](const json& reply) {
    const auto style = options.style();
    const auto description = reply.get<node_description>();
    auto text = node_view(description, style);
    if (description.role == node_role::coordinator)
      text += cell_summary(node.get("/v1/cell").get<cell_description>(), style);
    return text;
  };
  const auto* path = options.actors ? "/v1/node?actors=1" : "/v1/node";
  return show(options, node, [&] { return node.get(path); }, view, {});
}

/// Of the cell where the node can ask it, else of the node.
int show_cost(const show_options& options) {
  const node_client node{options.connection};
  try {
    const auto asked = node.get("/v1/node").get<node_description>();
    const bool cell = asked.role == node_role::coordinator
                      || asked.state == node_state::member;
    const auto reply = node.ask(message_json(cost_query{"", cell}), cost_limit);
    print(options.as_json()
              ? pretty(reply)
              : cost_view(reply.get<cost_report>(), options.style()));
    return exit_done;
  } catch (refused& e) {
    e.as_json = options.as_json();
    throw;
  }
}

} // namespace

void add_status_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<show_options>();
  auto* command = add_show_command(
      app, "status", "Show one node: its cell, resources and instances.",
      "--cost shows the time of a core, the memory, the bytes written to disks "
      "and what went\nover the sessions with other nodes, in the last minute, "
      "hour and day, of each node of the\ncell; SPAN is what a row really "
      "covers. A node in no cell shows itself.\n\n"
      "Examples:\n  roscell status\n  roscell status --watch\n"
      "  roscell status --actors --to 192.168.1.10\n"
      "  roscell status --cost -o json | jq '.nodes[].windows[0]'",
      options);
  add_output_option(*command, options->output);
  auto* actors =
      command->add_flag("--actors", options->actors,
                        "Also list the node's actors with their counters");
  command
      ->add_flag("--cost", options->cost,
                 "Show what the node and those of its cell cost instead")
      ->excludes(actors)
      ->excludes(command->get_option("--watch"));
  command->callback([&chosen, options] {
    chosen = [options] {
      return options->cost ? show_cost(*options) : show_status(*options);
    };
  });
}

} // namespace roscell::cli
