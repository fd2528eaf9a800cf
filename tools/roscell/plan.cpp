#include "actors/task_allocation.hpp"
#include "schemas/decode.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/plan_view.hpp"
#include "tools/roscell/read_file.hpp"
#include "tools/roscell/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <variant>

namespace roscell::cli {

namespace {

/// A plan is the operator's own file, so it may be larger than what a node
/// takes from a stranger: thousands of nodes.
constexpr document_limits plan_limits{64UL * 1024 * 1024, 64, 4'000'000, 256};

struct plan_options {
  std::string file;
  std::string output = "table";
};

using plan_result = std::variant<task_plan, failure>;

plan_result plan_of(const std::string& text) {
  auto parsed = parse_document(text, plan_limits);
  if (auto* why = std::get_if<failure>(&parsed))
    return *why;
  const auto& document = std::get<json>(parsed);
  if (auto why = validate_document("plan_document", document))
    return std::move(*why);
  auto decoded = decode<plan_document>(document);
  if (auto* why = std::get_if<failure>(&decoded))
    return *why;
  return allocate_offline(std::get<plan_document>(decoded));
}

/// Who was rejected, as the details of a failure tell.
std::vector<rejected_candidate> rejected_of(const failure& why) {
  const auto details = json::parse(why.details, nullptr, false);
  if (!details.is_object() || !details.contains("rejected"))
    return {};
  return details["rejected"].get<std::vector<rejected_candidate>>();
}

int show_refusal(const failure& why, bool as_json) {
  const auto reply = error_reply(why);
  if (as_json) {
    print(pretty(reply));
    return exit_refused;
  }
  if (const auto rejected = rejected_of(why); !rejected.empty())
    print(rejected_view(rejected, stdout_style()));
  print_refusal(reply);
  return exit_refused;
}

int show_plan(const plan_options& options) {
  const bool as_json = options.output == "json";
  const auto result = plan_of(read_file(options.file));
  if (const auto* why = std::get_if<failure>(&result))
    return show_refusal(*why, as_json);
  const auto& plan = std::get<task_plan>(result);
  print(as_json ? pretty(message_json(plan)) : plan_view(plan, stdout_style()));
  return exit_done;
}

} // namespace

void add_plan_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<plan_options>();
  auto* command = app.add_subcommand(
      "plan",
      "Allocate a task on nodes that a file describes; no node is asked.");
  command->footer(
      "The file is {\"nodes\":[...],\"skills\":[...],\"request\":{...}}; "
      "docs/operations.md\nshows one. Exit code 1: there is no allocation, and "
      "every candidate is explained.\n\n"
      "Examples:\n  roscell plan cell.json\n"
      "  roscell plan cell.json -o json | jq .score.total");
  command
      ->add_option("FILE", options->file,
                   "The plan document; - for standard "
                   "input")
      ->required()
      ->option_text(" ");
  add_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_plan(*options); };
  });
}

} // namespace roscell::cli
