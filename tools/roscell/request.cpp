#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/format.hpp"
#include "tools/roscell/node_client.hpp"
#include "tools/roscell/progress.hpp"
#include "tools/roscell/read_file.hpp"
#include "tools/roscell/terminal.hpp"

#include <CLI/CLI.hpp>

#include <future>
#include <memory>

namespace roscell::cli {

namespace {

/// What takes longer than this is told about.
constexpr std::chrono::seconds patience{1};

struct request_options {
  connection_options connection;
  std::string file = "-";
  std::string timeout = "120";
  bool progress = false;
};

/// The task that a request is about; empty if it names none. What is wrong
/// with the request is for the node to say.
std::string task_of(const std::string& body) {
  const auto document = json::parse(body, nullptr, false);
  if (!document.is_object() || !document.contains("task"))
    return {};
  const auto& task = document["task"];
  return task.is_string() ? task.get<std::string>() : "";
}

json post_with_progress(const node_client& node, const std::string& body,
                        std::chrono::milliseconds limit) {
  progress teller{node, task_of(body)};
  auto reply = std::async(std::launch::async, [&] {
    return node.post("/v1/requests", body, limit);
  });
  if (reply.wait_for(patience) == std::future_status::timeout) {
    print_note("waiting for " + node.where().text() + " ...");
    teller.begin();
  }
  return reply.get();
}

int send_request(const request_options& options) {
  const auto limit = parse_duration(options.timeout);
  const node_client node{options.connection};
  const auto body = read_file(options.file);
  const bool talkative = options.progress || stderr_is_terminal();
  const auto reply = talkative ? post_with_progress(node, body, limit)
                               : node.post("/v1/requests", body, limit);
  print(pretty(reply));
  return reply.value("type", "") == "error" ? exit_refused : exit_done;
}

std::string check_duration(const std::string& text) {
  try {
    parse_duration(text);
    return {};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

} // namespace

void add_request_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<request_options>();
  auto* command = app.add_subcommand(
      "request", "Send a JSON request to a node and print its JSON reply.");
  command->footer(
      "Exit code 1 means that the node refused; its error is the reply.\n\n"
      "Examples:\n  roscell request task.json\n"
      "  echo '{\"type\":\"cell_query\"}' | roscell request\n"
      "  roscell request --to 192.168.1.10 --token-file token task.json");
  command
      ->add_option("FILE", options->file,
                   "The request; - or nothing: standard input")
      ->option_text("[-]");
  add_connection_options(*command, options->connection);
  command
      ->add_option("--timeout", options->timeout,
                   "Longest wait for the reply, in seconds, or with a unit: "
                   "500ms, 2m, 1h")
      ->check(CLI::Validator{check_duration, "DURATION"})
      ->option_text("SECONDS [120]");
  command->add_flag("--progress", options->progress,
                    "Tell on standard error what goes on if it takes more "
                    "than a second, even if that is no terminal");
  command->callback([&chosen, options] {
    chosen = [options] { return send_request(*options); };
  });
}

} // namespace roscell::cli
