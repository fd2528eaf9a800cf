#include "messages/parameter_change.hpp"
#include "schemas/document.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "tools/roscell/client/find_instance.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/table.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace roscell::cli {

namespace {

/// The cell has `limits::task::parameters`.
constexpr std::chrono::seconds answer_limit{20};

struct set_options {
  connection_options connection;
  std::string output = "table";
  std::string subject; ///< An instance, or the beginning of its id.
  std::vector<std::string> pairs;
};

/// What can be set of the model that an instance runs.
declared_parameters parameters_of_instance(const node_client& node,
                                           const instance_row& instance) {
  const auto known = node.get("/v1/skills").get<skill_list>();
  for (const auto& row : known.skills)
    if (row.skill.hash == instance.spec.skill)
      for (const auto& model : row.skill.descriptor.models)
        if (model.name == instance.spec.model)
          return parameters_of(row.skill.descriptor, model);
  return {};
}

/// By the type that is declared: the text of a text, else as YAML, so that a
/// list is [1, 2].
json read_value(const std::string& name, const std::string& word,
                const declared_parameters& known) {
  const auto declared = known.find(name);
  if (declared != known.end() && declared->second.type == "string")
    return word;
  auto value = parse_document(word, document_format::yaml);
  if (const auto* why = std::get_if<failure>(&value))
    throw command_error{
        exit_usage, "the value of '" + printable(name) + "': " + why->message,
        "a list is [1, 2], an object {\"a\": 1}"};
  return std::get<json>(std::move(value));
}

json read_pairs(const std::vector<std::string>& pairs,
                const declared_parameters& known) {
  auto result = json::object();
  for (const auto& pair : pairs) {
    const auto equals = pair.find('=');
    const auto name = pair.substr(0, equals);
    if (equals == std::string::npos || name.empty())
      throw command_error{exit_usage,
                          "'" + printable(pair) + "' is no KEY=VALUE"};
    if (result.contains(name))
      throw command_error{exit_usage, "'" + printable(name) + "' is set twice"};
    result[name] = read_value(name, pair.substr(equals + 1), known);
  }
  return result;
}

json object_of(const std::string& text) {
  auto result = json::parse(text, nullptr, false);
  return result.is_object() ? result : json::object();
}

std::string value_text(const json& values, const std::string& name) {
  const auto found = values.find(name);
  return found == values.end()
             ? "-"
             : found->dump(-1, ' ', false, json::error_handler_t::replace);
}

/// "prefix: "a" -> "b"", a line for each.
std::string changes_text(const parameters_changed& reply, const json& wanted) {
  const auto former = object_of(reply.former);
  const auto now = object_of(reply.parameters);
  std::string result;
  for (const auto& [name, value] : wanted.items())
    result += printable(name + ": " + value_text(former, name) + " -> "
                        + value_text(now, name))
              + "\n";
  return result;
}

int list_changeable(const set_options& options, const instance_row& instance,
                    const declared_parameters& known) {
  const auto now = object_of(instance.spec.parameters);
  table shown{{{"PARAMETER"}, {"VALUE"}, {"TAKES"}, {"MEANING"}}, {}};
  auto list = json::object();
  for (const auto& [name, x] : known) {
    if (!x.changeable)
      continue;
    list[name] = now.value(name, json{});
    shown.rows.push_back({{printable(name)},
                          {printable(value_text(now, name))},
                          {printable(parameter_text(x))},
                          {printable(x.description)}});
  }
  if (options.output == "json")
    print(pretty(list));
  else if (shown.rows.empty())
    print_note("no parameter of '" + printable(instance.spec.instance)
               + "' can be changed while it runs");
  else
    print(shown.render(stdout_style()));
  return exit_done;
}

int set(const set_options& options) {
  const node_client node{options.connection};
  const auto instance = find_instance(node, options.subject);
  const auto known = parameters_of_instance(node, instance);
  if (options.pairs.empty())
    return list_changeable(options, instance, known);
  const auto wanted = read_pairs(options.pairs, known);
  const parameter_change request{instance.spec.instance, wanted.dump()};
  const auto reply = node.ask(message_json(request), answer_limit);
  if (options.output == "json")
    print(pretty(reply));
  else
    print(changes_text(reply.get<parameters_changed>(), wanted));
  return exit_done;
}

} // namespace

void add_set_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<set_options>();
  auto* command = app.add_subcommand(
      "set", "Change parameters of an instance while it runs.");
  command->footer(
      "Its program works with them from its next frame on, and goes on as it "
      "is. They are written\ndown in the task: also when it is started again "
      "or moves it has them, and `roscell apply` of\nits file shows the "
      "difference. Only what the skill marks as changeable can be set;\n"
      "without KEY=VALUE these are listed.\n\n"
      "Examples:\n  roscell set fleet-poses/detect\n"
      "  roscell set fleet-poses/detect decimation=3 refine=false");
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command
      ->add_option("INSTANCE", options->subject,
                   "Id of the instance or its beginning, or TASK/STEP")
      ->required()
      ->option_text(" ");
  command
      ->add_option("PARAMETER", options->pairs,
                   "Its parameters with their new values; a list is [1, 2]")
      ->option_text("KEY=VALUE...");
  command->callback(
      [&chosen, options] { chosen = [options] { return set(*options); }; });
}

} // namespace roscell::cli
