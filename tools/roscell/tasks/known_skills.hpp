#pragma once

#include "messages/skill.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// Where a command looks for skills: in folders of this machine, else in the
/// cell of a node.
struct skill_source {
  connection_options connection;
  std::vector<std::string> folders;
};

/// Adds --skills, --to and --token-file.
void add_skill_source(CLI::App& command, skill_source& source);

/// The skills that are there. Throws as `node_client` does, and command_error
/// for a folder without any skill.
skill_list find_skills(const skill_source& source);

/// The rows of an operation. Throws command_error with the one that was
/// probably meant, or with those that there are.
std::vector<skill_row> rows_of(const skill_list& skills,
                               const std::string& operation);

/// A task request in YAML that does these operations one after the other, with
/// comments on what to fill in. It is valid as it is: `roscell check` takes it.
/// A step reads what the one before it writes, where its skill takes that.
/// `skills` has every one of the operations.
std::string task_skeleton(const std::string& task,
                          const std::vector<std::string>& operations,
                          const skill_list& skills);

} // namespace roscell::cli
