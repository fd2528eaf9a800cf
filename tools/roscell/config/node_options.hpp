#pragma once

#include "roscell/node_config.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// The command line of `roscell node`.
struct node_options {
  node_config config;    ///< What needs no further thought.
  std::string interface; ///< Name or address; empty: to be asked.
  std::string log_bytes = "1MiB";
  std::string history_bytes = "64MiB";
  std::string builds_bytes = "20GiB";
  std::string history_age = "7d";
  std::vector<std::string> labels; ///< "key=value"
  std::vector<std::filesystem::path> skill_dirs;
  std::string drain_timeout = "0"; ///< A duration; 0: it is not drained.
  std::string log_level = "info";
  int ready_fd = -1; ///< Told when the node is ready; negative: none.
};

/// Adds them to a command, all but --config.
void add_node_options(CLI::App& command, node_options& options);

/// The configuration that the options mean, with absolute paths and without
/// the address. Throws command_error for a value that cannot be meant.
node_config to_config(const node_options& options);

} // namespace roscell::cli
