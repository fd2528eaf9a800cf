#pragma once

#include "messages/codec/json_codec.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/view/views.hpp"

#include <functional>
#include <memory>
#include <string>

/// What the commands have in common that show an answer of a node.
namespace roscell::cli {

struct show_options {
  connection_options connection;
  std::string output = "table";
  std::string argument;
  table_options tables;
  bool watch = false;
  bool actors = false;
  bool cost = false;
  bool history = false;
  bool revisions = false;

  bool as_json() const {
    return output == "json" || output == "jsonl";
  }

  /// How a table looks now.
  view_style style() const;
};

using options_ptr = std::shared_ptr<show_options>;

/// Shows what `fetch` gets, once or at every change; programs get the things in
/// these parts of it.
int show(const show_options& options, const node_client& node,
         const std::function<json()>& fetch,
         const std::function<std::string(const json&)>& view,
         const reply_parts& parts);

/// A command with the options that all of them have.
CLI::App* add_show_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           const options_ptr& options);

void add_status_command(CLI::App& app, action& chosen);

/// Prints the requests that a task has had; as JSON if so wanted.
void print_revisions(const node_client& node, const std::string& task,
                     bool as_json);

/// Prints what has happened to a task, in order; as JSON if so wanted.
void print_history(const node_client& node, const std::string& task,
                   bool as_json);

} // namespace roscell::cli
