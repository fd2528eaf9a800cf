#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/completion/completer.hpp"

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::cli {

/// The script with which bash, zsh or fish completes commands of `roscell`: it
/// asks `roscell completion --line` for the words.
std::string completion_script(const std::string& shell);

/// For such a script: in each line what the last word of `line` may become, a
/// tab and what that means. ":files" or ":dirs" stands for paths, which shells
/// find themselves, ":more" says that no blank follows. A name that is no plain
/// word is left out: a shell would expand it.
std::string completion_lines(const CLI::App& app, std::string_view line,
                             const name_lookup& names);

/// The names of what a cell has now, for completion. They are asked for when
/// they are wanted, with a short limit, and taken again for a moment, so that a
/// node that is gone keeps nobody who types.
class live_names {
public:
  explicit live_names(const node_client& node) : node_{node} {}

  /// @param kind "nodes", "cells", "tasks", "instances", "transfers" or
  /// "secrets".
  const std::vector<std::string>& of(const std::string& kind);

private:
  using clock = std::chrono::steady_clock;

  struct known {
    std::vector<std::string> names;
    clock::time_point asked;
  };

  const node_client& node_;
  std::map<std::string, known> known_;
};

/// The names in the answer to a question for that kind; no others.
std::vector<std::string> names_in(const std::string& kind, const json& reply);

} // namespace roscell::cli
