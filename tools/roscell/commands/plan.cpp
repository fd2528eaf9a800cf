#include "actors/placement/questions/task_allocation.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <variant>

namespace roscell::cli {

namespace {

/// A plan is the operator's own file, so it may be larger than what a node
/// takes from an unauthenticated peer: thousands of nodes.
constexpr document_limits plan_limits{64UL * 1024 * 1024, 64, 4'000'000, 256};

/// Reading resources may take some seconds, and there are two searches.
constexpr std::chrono::seconds plan_timeout{60};

struct plan_options {
  std::string file;
  std::string output = "table";
  std::string why;
  std::vector<std::string> without;
  std::vector<std::string> with; ///< Files.
  file_values values;
  bool preempt = false;
  connection_options connection;
};

using plan_result = std::variant<task_plan, failure>;
using document_result = std::variant<json, failure>;

document_result document_of(const std::string& file, const std::string& text) {
  return parse_document(text, format_of(file, text), plan_limits);
}

/// The nodes of the files; each holds one node or a list of them.
document_result nodes_in(const std::vector<std::string>& files) {
  auto nodes = json::array();
  for (const auto& file : files) {
    auto parsed = document_of(file, read_file(file));
    if (auto* why = std::get_if<failure>(&parsed)) {
      why->message = file + ": " + why->message;
      return std::move(*why);
    }
    auto& document = std::get<json>(parsed);
    if (document.is_array())
      nodes.insert(nodes.end(), document.begin(), document.end());
    else
      nodes.push_back(std::move(document));
  }
  for (auto& node : nodes)
    complete_paper_node(node);
  return nodes;
}

/// Takes nodes away from a document and adds others. What is wrong with those
/// is for the schema to say.
std::optional<failure> think_otherwise(const plan_options& options,
                                       json& document) {
  auto with = nodes_in(options.with);
  if (auto* why = std::get_if<failure>(&with))
    return std::move(*why);
  auto nodes = document.find("nodes");
  if (nodes == document.end() || !nodes->is_array())
    return std::nullopt;
  for (auto& node : *nodes)
    complete_paper_node(node);
  for (const auto& name : options.without) {
    auto named = [&](const json& x) {
      return x.is_object() && x.value("name", json{}) == name;
    };
    auto found = std::find_if(nodes->begin(), nodes->end(), named);
    if (found == nodes->end())
      return failure{error_code::unknown_node,
                     "the file has no node '" + name + "'", "/nodes",
                     "--without takes the name of one of its nodes"};
    nodes->erase(found);
  }
  for (auto& node : std::get<json>(with))
    nodes->push_back(std::move(node));
  return std::nullopt;
}

plan_result plan_on_paper(const plan_options& options, json document) {
  if (document.is_object())
    if (auto why = think_otherwise(options, document))
      return std::move(*why);
  if (auto why = validate_document("plan_document", document))
    return std::move(*why);
  auto decoded = decode<plan_document>(document);
  if (auto* why = std::get_if<failure>(&decoded))
    return *why;
  return allocate_offline(std::get<plan_document>(decoded), options.why);
}

/// The query for a file that is a task request, or a plan document with one.
document_result query_of(const plan_options& options, const json& document) {
  auto query = document;
  if (document.is_object() && document.contains("request"))
    query = document["request"];
  if (!query.is_object())
    return query;
  query["type"] = "task_plan_query";
  query.erase("request_id");
  if (!options.why.empty())
    query["why"] = options.why;
  if (!options.without.empty())
    query["without"] = options.without;
  query.erase("preempt");
  query.erase("force");
  query.erase("timeout_s");
  if (options.preempt)
    query["preempt"] = true;
  auto with = nodes_in(options.with);
  if (auto* why = std::get_if<failure>(&with))
    return std::move(*why);
  if (!std::get<json>(with).empty())
    query["with"] = std::move(std::get<json>(with));
  return query;
}

plan_result plan_of_cell(const plan_options& options, const json& document) {
  auto query = query_of(options, document);
  if (auto* why = std::get_if<failure>(&query))
    return std::move(*why);
  const auto& body = std::get<json>(query);
  if (auto why = validate_request(body))
    return std::move(*why);
  const auto reply = node_client{options.connection}.post(
      "/v1/requests", body.dump(), plan_timeout);
  if (reply.value("type", "") == "error")
    return failure_from(reply);
  auto decoded = decode<task_plan>(reply);
  if (auto* why = std::get_if<failure>(&decoded))
    return std::move(*why);
  return std::get<task_plan>(std::move(decoded));
}

/// A file that brings its own nodes is a cell on paper, unless a node is named
/// for it: $ROSCELL_TO names one for whatever has to ask.
bool is_on_paper(const plan_options& options, const json& document) {
  return options.connection.to.empty()
         && (!document.is_object() || document.contains("nodes")
             || document.contains("skills"));
}

plan_result plan_of(const plan_options& options, const std::string& text) {
  auto document = document_of(options.file, text);
  if (auto* read = std::get_if<json>(&document))
    document = fill_from(std::move(*read), options.values);
  if (auto* why = std::get_if<failure>(&document))
    return std::move(*why);
  auto& content = std::get<json>(document);
  return is_on_paper(options, content)
             ? plan_on_paper(options, std::move(content))
             : plan_of_cell(options, content);
}

int show_refusal(const failure& why, const plan_options& options,
                 const std::string& text) {
  const auto reply = error_reply(why);
  if (options.output == "json") {
    print(pretty(reply));
    return exit_code_of_refusal(reply);
  }
  if (const auto rejected = rejected_in(why); !rejected.empty())
    print(rejected_view(rejected, stdout_style()));
  // A query, and other nodes than the file's, move what pointers lead to.
  const bool as_written = options.connection.to.empty() && options.with.empty()
                          && options.without.empty();
  if (as_written)
    print_text(marked_errors(options.file, text, reply));
  print_refusal(reply);
  return exit_code_of_refusal(reply);
}

int show_plan(const plan_options& options) {
  const auto text = read_file(options.file);
  const auto result = plan_of(options, text);
  if (const auto* why = std::get_if<failure>(&result))
    return show_refusal(*why, options, text);
  const auto& plan = std::get<task_plan>(result);
  print(options.output == "json" ? pretty(message_json(plan))
                                 : plan_view(plan, stdout_style()));
  return exit_done;
}

} // namespace

void add_plan_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<plan_options>();
  auto* command = app.add_subcommand(
      "plan", "Show where a task would be placed and why; nothing is started.");
  command->footer(
      "FILE is a task request, and the cell of the node is asked as it is now. "
      "Or it is a\ncell on paper, with nodes, skills and a request, and nobody "
      "is asked;\ndocs/operations.md shows one. With --to its request goes to "
      "that node. Exit code 1:\nthere is no allocation, and every candidate "
      "is explained.\n\n"
      "Examples:\n  roscell plan cell.yaml\n  roscell plan task.yaml\n"
      "  roscell plan --to 192.168.1.10 --token-file token task.json\n"
      "  roscell plan --to unix:/srv/arm/node.sock --without arm-1 --why poses "
      "task.json\n"
      "  roscell plan cell.json -o json | jq .score.total");
  command
      ->add_option("FILE", options->file,
                   "The task request or plan document; - for standard input")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--without", options->without,
                   "Plan as if this node were not there; may be repeated")
      ->option_text("NODE")
      ->allow_extra_args(false);
  command
      ->add_option("--with", options->with,
                   "Plan as if the nodes of this file were there, with every "
                   "skill; may be repeated")
      ->option_text("FILE")
      ->allow_extra_args(false);
  command
      ->add_option("--why", options->why,
                   "Show the best alternative for this step and its cost")
      ->option_text("STEP");
  command->add_flag("--preempt", options->preempt,
                    "Where it does not fit, plan as if instances of lower "
                    "priority were preempted, and show them");
  add_value_options(*command, options->values);
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_plan(*options); };
  });
}

} // namespace roscell::cli
