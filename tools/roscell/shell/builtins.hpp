#pragma once

#include "tools/roscell/commands.hpp"
#include "tools/roscell/shell/follower.hpp"

#include <string>

/// The words of the shell's own. Each is added to the commands of `roscell` and
/// parsed like them; a new one has a file here and a line in vocabulary.cpp.
namespace roscell::cli {

/// The shell at a terminal, for the words that change it.
struct live_shell {
  follower& events;
  bool ended = false;
};

/// Heading of these words in the help.
inline constexpr auto own_announcement = "Words of the shell";

void add_tree_builtin(CLI::App& app, action& chosen);

/// `shell`: null where nobody types.
void add_follow_builtin(CLI::App& app, action& chosen, live_shell* shell);
void add_exit_builtin(CLI::App& app, action& chosen, live_shell* shell);

} // namespace roscell::cli
