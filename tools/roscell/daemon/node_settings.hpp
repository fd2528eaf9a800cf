#pragma once

#include "actors/node/spawn_node.hpp"
#include "tools/roscell/config/node_source.hpp"

#include <string>

namespace roscell::cli {

/// What a node of this process is set up with, and what of that may become
/// something else while it runs.
class node_settings {
public:
  /// `source` outlives it. Throws command_error for what cannot be meant.
  node_settings(const node_source& source, node_reading started);

  const node_options& options() const {
    return options_;
  }

  const node_config& config() const {
    return config_;
  }

  /// The next node is the same one: what was put aside once is not put aside
  /// again, and its name does not follow the MAC of another interface.
  void keep_identity(const std::string& name);

  /// Reads what the node was started with again, and has it take what it can.
  /// One event says what has changed and what needs a restart, or what is wrong
  /// with the file: then all is what it was.
  void read_again(const running_node& node);

private:
  void take(const node_reading& now, const running_node& node);
  void pass_on(const running_node& node) const;

  const node_source& source_;
  node_options options_;
  node_config config_;
  given_options in_use_;
};

} // namespace roscell::cli
