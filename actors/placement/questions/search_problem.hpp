#pragma once

#include "actors/placement/search/problem.hpp"
#include "messages/inside/placement.hpp"

#include <map>
#include <string>
#include <vector>

namespace roscell {

/// The ways to run a step that the search tells apart. Builds whose deployments
/// ask for the same share one, whichever node has which build.
class step_ways {
public:
  explicit step_ways(const resolved_step& step);

  /// The step as the search takes it.
  allocation::step to_search() const;

  /// The deployment's name.
  const std::string& name(size_t way) const {
    return ways_[way].option.name;
  }

  const deployment_option& option(size_t way) const {
    return ways_[way].option;
  }

  const std::string& skill() const {
    return step_.step.operation;
  }

  /// Hash of the build that a node runs in this way; empty if it has none.
  std::string build(size_t way, const std::string& node) const;

  /// The way behind a deployment's name on a node; `count()` if there is none.
  size_t find(const std::string& deployment, const std::string& node) const;

  size_t count() const {
    return ways_.size();
  }

private:
  struct way {
    deployment_option option;
    std::map<std::string, std::string> builds; ///< By node.
  };

  void add(const deployment_option& option, const skill_build& build);

  const resolved_step& step_;
  std::vector<way> ways_;
};

// From messages to what the search works on.

/// To say "on that robot" needs no label of its own: each node has one with its
/// name, unless its operator has given it another value.
std::map<std::string, std::string> labels_of(const node_resources& x);

/// Position of a step; the number of steps if there is none of that id.
size_t step_position(const std::vector<resolved_step>& steps,
                     const std::string& id);

/// Position of a node; the number of nodes if there is none of that name.
size_t node_position(const std::vector<node_resources>& nodes,
                     const std::string& name);

/// What a node has to fetch before it runs a build of a step.
int64_t bytes_to_fetch(const resolved_step& step, const std::string& build,
                       const std::string& node);

/// The nodes that have to fetch the least come first, so that of allocations
/// that are as good as each other one is taken that starts soon.
std::vector<node_resources>
in_order_of_fetching(std::vector<node_resources> nodes,
                     const std::vector<resolved_step>& steps);

std::vector<step_ways> ways_of(const std::vector<resolved_step>& steps);

/// Excluded from it is only what nodes do not grant.
allocation::problem make_problem(const std::vector<node_resources>& nodes,
                                 const std::vector<step_ways>& ways);

} // namespace roscell
