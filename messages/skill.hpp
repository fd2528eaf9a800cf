#pragma once

#include "messages/skill_descriptor.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A skill folder that a node has. Two folders of the same content have the
/// same hash, whatever their names and places.
struct installed_skill {
  std::string hash; ///< SHA-256 over the folder's content, 64 hex digits.
  skill_descriptor descriptor;

  static constexpr auto fields() {
    return std::make_tuple(
        required("hash", &installed_skill::hash),
        required("descriptor", &installed_skill::descriptor));
  }
};

/// Asks which skills the cell, or an independent node, can run.
struct skill_query {
  static constexpr const char* type = "skill_query";
  std::string operation; ///< Empty: all.

  static constexpr auto fields() {
    return std::make_tuple(optional("operation", &skill_query::operation));
  }
};

/// One skill and the nodes that have it.
struct skill_row {
  installed_skill skill;
  std::vector<std::string> nodes;

  static constexpr auto fields() {
    return std::make_tuple(required("skill", &skill_row::skill),
                           required("nodes", &skill_row::nodes));
  }
};

struct skill_list {
  static constexpr const char* type = "skill_list";
  std::vector<skill_row> skills;

  static constexpr auto fields() {
    return std::make_tuple(required("skills", &skill_list::skills));
  }
};

} // namespace roscell
