#include "actors/edge/io/node_time.hpp"
#include "messages/failure.hpp"
#include "messages/insight/request_trace.hpp"
#include "schemas/document.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/insight/insight_views.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct insight_options {
  connection_options connection;
  std::string output = "table";
  std::string subject;
  bool all = false;

  bool as_json() const {
    return output == "json";
  }
};

/// A coordinator answers at once from what it keeps.
constexpr std::chrono::seconds insight_limit{10};

json insight(const insight_options& options, const json& query) {
  return unless_refused(node_client{options.connection}.post(
                            "/v1/requests", query.dump(), insight_limit),
                        options.as_json());
}

/// Why it was refused is told as the request was told it.
int show_decision(const task_placement& of) {
  const auto when = local_time(of.decided_unix_ms);
  if (of.refusal.empty()) {
    const auto plan = json::parse(of.plan).get<task_plan>();
    print("task '" + printable(of.task) + "' was placed so, " + when + "\n\n"
          + plan_view(plan, stdout_style()));
    return exit_done;
  }
  const auto refusal = json::parse(of.refusal);
  print("task '" + printable(of.task) + "' was refused, " + when + "\n\n"
        + rejected_view(rejected_in(failure_from(refusal)), stdout_style()));
  print_refusal(refusal);
  return exit_done;
}

int explain(const insight_options& options) {
  const auto reply =
      insight(options, message_json(task_placement_query{options.subject}));
  if (!options.as_json())
    return show_decision(reply.get<task_placement>());
  print(pretty(reply));
  return exit_done;
}

int trace(const insight_options& options) {
  const auto reply =
      insight(options, message_json(request_trace_query{options.subject}));
  if (options.as_json()) {
    print(pretty(reply));
    return exit_done;
  }
  const auto traces = reply.get<request_traces>().requests;
  if (traces.empty())
    throw command_error{exit_refused, "no request about it is kept",
                        "the latest 100 since the coordinator's start are; "
                        "`roscell trace` shows them"};
  const bool newest_only = !options.subject.empty() && !options.all;
  std::string text;
  for (size_t i = newest_only ? traces.size() - 1 : 0; i < traces.size(); ++i)
    text += (text.empty() ? "" : "\n") + trace_view(traces[i], stdout_style());
  print(text);
  return exit_done;
}

CLI::App* add_insight(CLI::App& app, action& chosen, const char* name,
                      const char* description,
                      int (*run)(const insight_options&),
                      const std::shared_ptr<insight_options>& options) {
  auto* command = app.add_subcommand(name, description);
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command->callback(
      [&chosen, options, run] { chosen = [=] { return run(*options); }; });
  return command;
}

} // namespace

void add_decision_commands(CLI::App& app, action& chosen) {
  auto why = std::make_shared<insight_options>();
  auto* explaining = add_insight(
      app, chosen, "why",
      "Show why a task was placed as it was, or why it was refused.", explain,
      why);
  explaining->footer(
      "It is the explanation of that decision, when the task was asked for the "
      "last time;\n`roscell plan` shows how it would be decided now. The "
      "latest 100 decisions since the\ncoordinator's start are kept.\n\n"
      "Examples:\n  roscell why handover\n"
      "  roscell why handover -o json | jq .plan.score");
  explaining->add_option("TASK", why->subject, "The task")
      ->required()
      ->option_text(" ");
  auto way = std::make_shared<insight_options>();
  auto* tracing = add_insight(
      app, chosen, "trace",
      "Show the way of a request through the coordinator, with times.", trace,
      way);
  tracing->footer(
      "Each handler is a hop; below it is which actors it has asked, for which "
      "node, and how\nlong they took. Kept are the latest 100 requests that "
      "were no queries. What happened\nto the task afterwards: `roscell tasks "
      "TASK --history`.\n\n"
      "Examples:\n  roscell trace handover\n  roscell trace arm-1 --all\n"
      "  roscell trace");
  tracing
      ->add_option("SUBJECT", way->subject,
                   "The task or node that it was about; all of them if left "
                   "out")
      ->option_text(" ");
  tracing->add_flag("--all", way->all,
                    "Every request about it, not only the newest");
}

} // namespace roscell::cli
