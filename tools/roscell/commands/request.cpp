#include "schemas/document.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/preemption.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/marked_errors.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>
#include <variant>

namespace roscell::cli {

namespace {

struct request_options {
  connection_options connection;
  std::string file = "-";
  std::string timeout = "120";
  bool progress = false;
  bool wait_finished = false;
  file_values values;
  preemption_options preemption;
};

/// What is sent of a file: the JSON that YAML means, with its variables filled
/// in. JSON without any goes as it is, and what is wrong with it is for the
/// node to say.
std::variant<std::string, failure> body_of(const request_options& options,
                                           std::string text) {
  const auto format = format_of(options.file, text);
  const bool has_variables = text.find("\"variables\"") != std::string::npos
                             || !options.values.set.empty()
                             || !options.values.files.empty();
  if (format == document_format::json && !has_variables
      && !options.preemption.preempt && !options.preemption.force)
    return text;
  auto parsed = parse_document(text, format);
  if (auto* read = std::get_if<json>(&parsed))
    parsed = fill_from(std::move(*read), options.values);
  if (auto* why = std::get_if<failure>(&parsed))
    return std::move(*why);
  auto& document = std::get<json>(parsed);
  apply(options.preemption, document);
  return document.dump();
}

/// The task that a request is about; empty if it names none. What is wrong
/// with the request is for the node to say.
std::string task_of(const std::string& body) {
  const auto document = json::parse(body, nullptr, false);
  if (!document.is_object() || !document.contains("task"))
    return {};
  const auto& task = document["task"];
  return task.is_string() ? task.get<std::string>() : "";
}

json reply_to(const request_options& options, const std::string& body) {
  const auto limit = parse_duration(options.timeout);
  const node_client node{options.connection};
  const bool talkative = options.progress || stderr_is_terminal();
  const auto words = [task = task_of(body)](const event& e) {
    return progress_lines(e, task);
  };
  return talkative ? post_with_progress(node, body, limit, words)
                   : node.post("/v1/requests", body, limit);
}

/// Events after the request are looked at from before it, so none is missed.
int request_and_wait(const request_options& options, const std::string& text,
                     const std::string& body) {
  const node_client node{options.connection};
  const auto since = last_event_of_coordinator(node);
  const auto reply = reply_to(options, body);
  print(pretty(reply));
  if (reply.value("type", "") == "error") {
    print_text(marked_errors(options.file, text, reply));
    return exit_code_of_refusal(reply);
  }
  return wait_until_ended(node, reply.get<task_accepted>(), since);
}

int send_request(const request_options& options) {
  const auto text = read_file(options.file);
  const auto body = body_of(options, text);
  const auto* unreadable = std::get_if<failure>(&body);
  if (options.wait_finished && unreadable == nullptr)
    return request_and_wait(options, text, std::get<std::string>(body));
  const auto reply = unreadable != nullptr
                         ? error_reply(*unreadable)
                         : reply_to(options, std::get<std::string>(body));
  print(pretty(reply));
  if (reply.value("type", "") != "error")
    return exit_done;
  print_text(marked_errors(options.file, text, reply));
  return exit_code_of_refusal(reply);
}

} // namespace

void add_request_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<request_options>();
  auto* command = app.add_subcommand(
      "request",
      "Send a request, written in YAML or JSON, and print the JSON reply.");
  command->footer(
      "Exit code 1 means that the node refused; its error is the reply, and "
      "standard error\nshows each place of the request that is wrong.\n\n"
      "Examples:\n  roscell request task.yaml\n"
      "  echo 'type: cell_query' | roscell request\n"
      "  roscell request --to 192.168.1.10 --token-file token task.json");
  command
      ->add_option("FILE", options->file,
                   "The request; - or nothing: standard input")
      ->option_text("[-]");
  add_connection_options(*command, options->connection);
  add_timeout_option(*command, options->timeout);
  command->add_flag("--progress", options->progress,
                    "Report on standard error what goes on if it takes more "
                    "than a second, even if that is no terminal");
  command->add_flag("--wait-finished", options->wait_finished,
                    "Wait until the task has ended by itself; the exit code is "
                    "that of its first step that failed");
  add_value_options(*command, options->values);
  add_preemption_options(*command, options->preemption);
  command->callback([&chosen, options] {
    chosen = [options] { return send_request(*options); };
  });
}

} // namespace roscell::cli
