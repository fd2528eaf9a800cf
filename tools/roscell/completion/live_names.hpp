#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace roscell::cli {

/// The names of what a cell has now, for completion. They are asked for when
/// they are wanted, with a short limit, and taken again for a moment, so that a
/// node that is gone keeps nobody who types.
class live_names {
public:
  explicit live_names(const node_client& node) : node_{node} {}

  /// @param kind "nodes", "cells", "tasks", "instances" or "transfers".
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
