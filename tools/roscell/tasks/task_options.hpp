#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>

namespace CLI {
class App;
} // namespace CLI

/// What the commands have in common that change a task.
namespace roscell::cli {

struct task_options {
  connection_options connection;
  std::string output = "table";
  std::string timeout = "120";
  bool force = false; ///< Nobody is waited for that is not stop-safe.

  bool as_json() const {
    return output == "json";
  }
};

/// A command with the options of all of them but --force.
CLI::App* add_task_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           task_options& options);

/// Adds --force.
void add_force_option(CLI::App& command, task_options& options);

/// Sends a request about a task and tells what goes on until it is answered.
json ask_about(const task_options& options, const std::string& task,
               const json& request);

/// The same where a refusal has no document to point into: it is thrown.
json ask_or_throw(const task_options& options, const std::string& task,
                  const json& request);

} // namespace roscell::cli
