#include "actors/cell/sets/set_template.hpp"
#include "actors/placement/reading/step_copies.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/known_skills.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

namespace roscell::cli {

namespace {

struct check_options {
  skill_source skills;
  std::string file;
  file_values values;
  bool quiet = false;
};

bool names_a_cell(const check_options& options) {
  const auto* to = std::getenv("ROSCELL_TO");
  return !options.skills.connection.to.empty() || (to != nullptr && *to != 0);
}

/// What the steps of the cell's tasks write.
std::vector<deployed_end> written_in_cell(const check_options& options) {
  const auto tasks = node_client{options.skills.connection}
                         .get("/v1/tasks")
                         .get<task_description>();
  std::vector<deployed_end> result;
  for (const auto& task : tasks.tasks)
    for (const auto& x : task.instances)
      for (const auto& end : x.spec.output)
        if (is_live(x.state))
          result.push_back({task.task, x.spec.step, x.node, end});
  return result;
}

/// That of the node of this host, as all other commands take it; none if no
/// node answers there.
std::optional<reading_context>
context_of_own_node(const check_options& options) {
  reading_context result;
  try {
    result.skills = find_skills(options.skills);
    result.written = written_in_cell(options);
  } catch (const command_error& why) {
    if (why.code != exit_unreachable)
      throw;
    return std::nullopt;
  } catch (const refused&) {
    // A node in no cell knows its own skills, and no other tasks.
  }
  return result;
}

/// What the request is checked against; none: its form only.
std::optional<reading_context> context_of(const check_options& options,
                                          const task_file& file) {
  if (!file.request_at.empty()) {
    reading_context paper;
    for (const auto& x : file.document.at("skills"))
      paper.skills.skills.push_back(
          {{"", x.get<skill_descriptor>(), "", {}, 0}, {"paper"}, {}});
    return paper;
  }
  if (!options.skills.folders.empty())
    return reading_context{find_skills(options.skills), {}, {}};
  if (names_a_cell(options))
    return reading_context{
        find_skills(options.skills), written_in_cell(options), {}};
  return context_of_own_node(options);
}

void check_form(const task_file& file) {
  auto why = file.request_at.empty()
                 ? validate_request(file.request())
                 : validate_document("plan_document", file.document);
  if (why)
    throw wrong_document{file, *why};
}

/// The request without short forms.
json written_out(const task_request& request, const task_reading& reading) {
  auto result = request;
  for (size_t i = 0; i < reading.steps.size(); ++i)
    result.pipeline[i] = reading.steps[i].step;
  return message_json(result);
}

task_reading read_request(const task_file& file, const task_request& request,
                          const reading_context& context) {
  auto reading = read_task(request.task, request.pipeline, context,
                           file.request_at + "/pipeline");
  if (auto* why = std::get_if<failure>(&reading))
    throw wrong_document{file, std::move(*why)};
  return std::get<task_reading>(std::move(reading));
}

/// The request with its copies; of a set that of a node which is thought of.
task_request meant_request(const task_file& file) {
  const auto document = file.request();
  std::variant<task_request, failure> result;
  if (document.value("type", "") == task_set_request::type) {
    result = task_for(document.get<task_set_request>(), "node");
  } else {
    auto request = document.get<task_request>();
    auto steps = with_copies(request.pipeline);
    if (auto* why = std::get_if<failure>(&steps))
      result = std::move(*why);
    else
      request.pipeline = std::get<std::vector<task_step>>(std::move(steps));
    if (std::holds_alternative<task_request>(result))
      result = std::move(request);
  }
  if (auto* why = std::get_if<failure>(&result))
    throw wrong_document{file, within(std::move(*why), file.request_at)};
  return std::get<task_request>(std::move(result));
}

int check(const check_options& options) {
  const auto file = read_task_file(options.file, options.values);
  check_form(file);
  const auto request = meant_request(file);
  const auto context = context_of(options, file);
  if (!context) {
    print_note("the form is right; no node of this host answers: say where its "
               "skills are with --skills DIR, or a cell with --to, to have the "
               "rest checked");
    return exit_done;
  }
  const auto reading = read_request(file, request, *context);
  for (const auto& warning : reading.warnings)
    print_note("warning: " + printable(warning));
  const auto count = reading.steps.size();
  print_note("nothing is wrong with task '" + printable(request.task) + "' of "
             + std::to_string(count) + (count == 1 ? " step" : " steps"));
  if (!options.quiet)
    print(pretty(written_out(request, reading)));
  return exit_done;
}

} // namespace

void add_check_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<check_options>();
  auto* command = app.add_subcommand(
      "check", "Check a task request or plan document; nothing is started.");
  command->footer(
      "Checks the form, the skills, their parameters, and that what is read is "
      "written. Prints\nthe request without its short forms. A plan document "
      "brings its skills; for a request\nthey are looked for in --skills, else "
      "in the cell of --to, $ROSCELL_TO or this host's node,\nwhere also the "
      "topics of its other tasks are known.\n\n"
      "Examples:\n  roscell check --skills build/release/skills task.yaml\n"
      "  roscell check --to 192.168.1.10 task.yaml\n"
      "  roscell check cell.json");
  command
      ->add_option("FILE", options->file,
                   "The task request or plan document; - for standard input")
      ->required()
      ->option_text(" ");
  add_value_options(*command, options->values);
  command->add_flag("-q,--quiet", options->quiet,
                    "Do not print the request written out");
  add_skill_source(*command, options->skills);
  command->callback([&chosen, options] {
    chosen = [options] {
      return with_marks(false, [&] { return check(*options); });
    };
  });
}

} // namespace roscell::cli
