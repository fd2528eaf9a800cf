#include "tools/roscell/commands/show.hpp"

#include "actors/core/clocks.hpp"
#include "actors/edge/http/http_target.hpp"
#include "messages/task.hpp"
#include "messages/task_update.hpp"
#include "tools/roscell/client/watch.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/ros2/found_topic.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/update_view.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

/// A coordinator answers at once. By then one that is stopped is known as such.
constexpr std::chrono::seconds view_limit{20};

constexpr const char* tasks_path = "/v1/tasks";

/// What one of these commands asks and how it shows the answer.
struct subject {
  const char* name;
  const char* description;
  const char* footer;
  const char* argument; ///< Name of an optional argument; nullptr: none.
  const char* path;     ///< Where the answer is; the argument is appended.
  reply_parts parts;    ///< What is listed of it.
  std::string (*view)(const json& reply, const view_style& style);
  /// The same for one thing that was named; nullptr: as for all.
  std::string (*one)(const json& reply, const view_style& style) = nullptr;
  const char* table_query = ""; ///< What a table can do without is left out.
};

template <class Message, std::string (*View)(const Message&, const view_style&)>
std::string view_of(const json& reply, const view_style& style) {
  return View(reply.get<Message>(), style);
}

const subject subjects[] = {
    {"cells",
     "List the cells that the node knows of.",
     "Examples:\n  roscell cells\n  roscell cells --watch",
     nullptr,
     "/v1/cells",
     {"cells"},
     view_of<cell_list, cells_view>},
    {"nodes",
     "List the nodes of the cell with their resources (used/capacity), then "
     "those that are in no cell.",
     "A member asks its coordinator.\n\nExamples:\n  roscell nodes\n"
     "  roscell nodes --watch --to 192.168.1.10",
     nullptr,
     "/v1/cell",
     {"nodes", "free"},
     view_of<cell_description, members_view>},
    {"tasks",
     "List the tasks of the cell.",
     "A member asks its coordinator.\n\nExamples:\n  roscell tasks --watch\n"
     "  roscell tasks fleet-poses -o json",
     "TASK",
     tasks_path,
     {"tasks"},
     view_of<task_description, tasks_view>,
     view_of<task_description, task_view>},
    {"instances",
     "List the skill instances of the cell, or of a lone node.",
     "Examples:\n  roscell instances\n"
     "  roscell instances fleet-poses-camera-1a2b3c4d -o json",
     "INSTANCE",
     "/v1/instances",
     {"instances"},
     view_of<instance_description, instances_view>,
     view_of<instance_description, instance_view>},
    {"topics",
     "List the ROS 2 topics of the cell, who writes and who reads them.",
     "Each end is named by its instance; a stock ROS 2 program by its enclave, "
     "which is / unless\nit was given another. Ends whose QoS does not match "
     "are listed below the table.\nA member asks its coordinator.\n\n"
     "Examples:\n  roscell topics\n  roscell topics -o json",
     nullptr,
     "/v1/topics",
     {"topics"},
     view_of<topic_list, topics_view>},
    {"skills",
     "List the skills that the cell, or a lone node, can run.",
     "Examples:\n  roscell skills\n  roscell skills -o json",
     nullptr,
     "/v1/skills",
     {"skills"},
     view_of<skill_list, skills_view>,
     nullptr,
     "?brief"},
};

/// The things as a program gets them: one document, or one in each line.
std::string json_text(const show_options& options, const json& things) {
  if (options.output == "json")
    return pretty(things);
  std::string lines;
  for (const auto& x : things)
    lines += compact(x);
  return lines;
}

/// Tasks, one if it is named, with what their instances say now, which only
/// their nodes know. They are asked first: what they say may show that a task
/// is not well.
json tasks_now(const node_client& node, const std::string& path,
               const std::string& name) {
  instance_query query;
  query.task = name;
  std::map<std::string, json> rows;
  for (auto& row : node.ask(message_json(query), view_limit)
                       .value("instances", json::array())) {
    const auto id = row.at("spec").at("instance").get<std::string>();
    rows[id] = std::move(row);
  }
  auto reply = node.get(path);
  for (auto& task : reply.at("tasks"))
    for (auto& row : task.at("instances")) {
      const auto known =
          rows.find(row.at("spec").at("instance").get<std::string>());
      if (known != rows.end())
        row = std::move(known->second);
    }
  return reply;
}

int show_subject(const subject& what, const show_options& options) {
  const node_client node{options.connection};
  if (options.history) {
    print_history(node, options.argument, options.as_json());
    return exit_done;
  }
  if (options.revisions) {
    print_revisions(node, options.argument, options.as_json());
    return exit_done;
  }
  auto path = std::string{what.path};
  if (!options.argument.empty())
    path += "/" + percent_encode(options.argument);
  if (!options.as_json())
    path += what.table_query;
  return show(
      options, node,
      [&] {
        return what.path == tasks_path ? tasks_now(node, path, options.argument)
                                       : node.get(path);
      },
      [&](const json& reply) {
        const bool one = what.one != nullptr && !options.argument.empty();
        return (one ? what.one : what.view)(reply, options.style());
      },
      what.parts);
}

int show_transfers(const show_options& options) {
  const node_client node{options.connection};
  const auto query = message_json(transfer_query{options.argument});
  return show(
      options, node, [&] { return node.ask(query, view_limit); },
      [&](const json& reply) {
        return transfers_view(reply.get<transfer_description>(),
                              options.style());
      },
      {"transfers"});
}

void add_transfers_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<show_options>();
  auto* command = add_show_command(
      app, "transfers", "List the transfers and releases of the cell's nodes.",
      "A member asks its coordinator. Those that have ended are forgotten "
      "after 100 others,\nand when the coordinator is started again.\n\n"
      "Examples:\n  roscell transfers --watch\n"
      "  roscell transfers lab-3-1 -o json",
      options);
  add_table_options(*command, options->output, options->tables);
  command->add_option("TRANSFER", options->argument, "Only this one");
  command->callback([&chosen, options] {
    chosen = [options] { return show_transfers(*options); };
  });
}

} // namespace

view_style show_options::style() const {
  auto result = view_style_now();
  result.text.tables = tables;
  result.text.tables.wide = output == "wide";
  return result;
}

int show(const show_options& options, const node_client& node,
         const std::function<json()>& fetch,
         const std::function<std::string(const json&)>& view,
         const reply_parts& parts) {
  const auto fetch_things = [&] { return shaped_list(fetch(), parts); };
  try {
    if (options.watch && options.as_json())
      return watch(node, true, fetch_things, view);
    if (options.watch)
      return watch(node, false, fetch, view);
    print(options.as_json() ? json_text(options, fetch_things())
                            : view(fetch()));
    return exit_done;
  } catch (refused& e) {
    e.as_json = options.as_json();
    throw;
  }
}

CLI::App* add_show_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           const options_ptr& options) {
  auto* command = app.add_subcommand(name, description);
  command->footer(footer);
  add_connection_options(*command, options->connection);
  command->add_flag("-w,--watch", options->watch,
                    "Show it again whenever something happens; with -o json "
                    "one document per change and line. Ctrl-C ends");
  return command;
}

namespace {

/// What can be asked of one task besides.
void add_task_flags(CLI::App& command, show_options& options) {
  auto* task = command.get_option("TASK");
  auto* history = command.add_flag("--history", options.history,
                                   "Show what has happened to TASK, in order");
  history->needs(task);
  command
      .add_flag("--revisions", options.revisions,
                "Show the requests that TASK has had")
      ->needs(task)
      ->excludes(history);
}

void add_subject_command(CLI::App& app, const subject& what, const char* name,
                         action& chosen) {
  auto options = std::make_shared<show_options>();
  auto* command =
      add_show_command(app, name, what.description, what.footer, options);
  add_table_options(*command, options->output, options->tables);
  if (what.argument != nullptr)
    command->add_option(what.argument, options->argument, "Only this one");
  if (command->get_name() == "tasks")
    add_task_flags(*command, *options);
  command->callback([&chosen, &what, options, command] {
    // A command below it has been chosen already.
    if (command->get_subcommands().empty())
      chosen = [&what, options] { return show_subject(what, *options); };
  });
}

/// What `skills` alone does, for who looks for it beside its other commands.
void add_skill_list_command(CLI::App& skills, action& chosen) {
  for (const auto& what : subjects)
    if (skills.get_name() == what.name)
      add_subject_command(skills, what, "list", chosen);
}

} // namespace

void add_show_commands(CLI::App& app, action& chosen) {
  add_status_command(app, chosen);
  for (const auto& what : subjects)
    add_subject_command(app, what, what.name, chosen);
  auto& skills = *app.get_subcommand("skills")->alias("skill");
  add_skill_show_command(skills, chosen);
  add_skill_new_command(skills, chosen);
  add_skill_check_command(skills, chosen);
  add_skill_add_command(skills, chosen);
  add_skill_sign_command(skills, chosen);
  add_skill_remove_command(skills, chosen);
  add_skill_pull_command(skills, chosen);
  add_skill_list_command(skills, chosen);
  add_transfers_command(app, chosen);
}

namespace {

/// A coordinator answers at once.
constexpr std::chrono::seconds history_limit{10};

} // namespace

void print_revisions(const node_client& node, const std::string& task,
                     bool as_json) {
  const auto reply =
      node.ask(message_json(task_revisions_query{task}), history_limit);
  print(as_json ? pretty(reply)
                : revisions_view(reply.get<task_revisions>(), stdout_style(),
                                 unix_now_ms()));
}

void print_history(const node_client& node, const std::string& task,
                   bool as_json) {
  const auto reply =
      node.ask(message_json(task_history_query{task}), history_limit);
  if (as_json) {
    print(pretty(reply));
    return;
  }
  const auto history = reply.get<task_history>();
  const auto width = stdout_style().width;
  std::string text = event_heading(width) + "\n";
  uint64_t before = 0;
  for (const auto& e : history.events) {
    if (e.sequence > before + 1)
      text += "... " + std::to_string(e.sequence - before - 1)
              + " more, which are not kept\n";
    before = e.sequence;
    text += shortened_line(event_line(e, width)) + "\n";
  }
  print(text);
}

} // namespace roscell::cli
