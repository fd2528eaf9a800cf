#include "actors/edge/http/http_target.hpp"
#include "messages/task.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/graph/graph_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

/// The coordinator asks the members, and waits no longer than this.
constexpr std::chrono::seconds metrics_limit{10};

struct graph_options {
  connection_options connection;
  std::string task;
  std::string output = "text";
};

/// The steps of a task in the order in which data flow through them. Refused,
/// with a reason, if there is no such task.
std::vector<instance_row> ask_for_steps(const node_client& node,
                                        const std::string& task) {
  std::vector<instance_row> result;
  for (auto& x : node.get("/v1/tasks/" + percent_encode(task))
                     .get<task_description>()
                     .tasks)
    for (auto& step : x.instances)
      result.push_back(std::move(step));
  return result;
}

task_graph ask_for_graph(const node_client& node, const std::string& task) {
  auto steps = ask_for_steps(node, task);
  instance_query query;
  query.task = task;
  const auto measured = node.ask(message_json(query), metrics_limit)
                            .get<instance_description>()
                            .instances;
  for (const auto& x : measured)
    for (auto& step : steps)
      if (step.spec.instance == x.spec.instance)
        step = x;
  return graph_of(task, std::move(steps));
}

std::string text_of(const task_graph& graph, const graph_options& options) {
  if (options.output == "dot")
    return dot_text(graph);
  if (options.output == "mermaid")
    return mermaid_text(graph);
  if (options.output == "json")
    return pretty(graph_json(graph));
  auto style = view_style_now();
  style.text.tables.wide = options.output == "wide";
  return graph_view(graph, style);
}

int show_graph(const graph_options& options) {
  const node_client node{options.connection};
  try {
    print(text_of(ask_for_graph(node, options.task), options));
  } catch (refused& e) {
    e.as_json = options.output == "json";
    throw;
  }
  return exit_done;
}

} // namespace

void add_graph_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<graph_options>();
  auto* command = app.add_subcommand(
      "graph", "Draw the steps of a task and what flows between them.");
  command->footer("Only a coordinator can answer.\n\nExamples:\n"
                  "  roscell graph fleet-poses\n"
                  "  roscell graph fleet-poses -o dot | dot -Tsvg > poses.svg");
  add_connection_options(*command, options->connection);
  command->add_option("TASK", options->task, "Name of the task")->required();
  command->add_option("-o,--output", options->output, "Form of what is printed")
      ->check(CLI::IsMember({"text", "wide", "dot", "mermaid", "json"}))
      ->option_text("text|wide|dot|mermaid|json [text]");
  command->callback([&chosen, options] {
    chosen = [options] { return show_graph(*options); };
  });
}

} // namespace roscell::cli
