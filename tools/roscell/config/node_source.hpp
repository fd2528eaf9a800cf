#pragma once

#include "tools/roscell/config/node_options.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace roscell::cli {

/// The values of options that were given, by long name without dashes.
using given_options = std::map<std::string, std::vector<std::string>>;

/// What a node is started with, as it is read.
struct node_reading {
  node_options options;
  given_options given; ///< By the command line and the file.
};

/// Where a node's options come from: the command line, of which only what it
/// says is kept, and a file, which may say something else later.
class node_source {
public:
  /// `command` has been parsed. An empty path: there is no file.
  node_source(CLI::App& command, std::filesystem::path file);

  /// Throws command_error, with the file and the line where it is the file's
  /// fault. What it gives can be meant: `to_config` takes it.
  node_reading read() const;

private:
  given_options given_; ///< By the command line.
  std::filesystem::path file_;
};

/// Runs a node until SIGINT or SIGTERM, and reads its options again at SIGHUP.
/// Returns the exit code.
int run_node(const node_source& source);

/// What may be different while a node runs, of those that differ.
struct option_changes {
  std::vector<std::string> changed;       ///< All of them.
  std::vector<std::string> needs_restart; ///< Those that a new start takes.
};

option_changes option_changes_between(const given_options& in_use,
                                      const given_options& read);

/// What is in use once the others have been taken: what needs a restart is what
/// it was.
given_options in_use_after(const given_options& in_use,
                           const given_options& read);

} // namespace roscell::cli
