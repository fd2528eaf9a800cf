#pragma once

#include "messages/skill_descriptor.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A build of a skill that a node has: a skill folder. Operation and version
/// say which skill it is. Two folders of the same content have the same hash,
/// whatever their names and places.
struct installed_skill {
  std::string hash; ///< SHA-256 over the folder's content, 64 hex digits.
  skill_descriptor descriptor;
  /// The descriptor's; else that of its sources, which a build may leave in
  /// `skill.version`; else the hash.
  std::string version;
  /// What its program is compiled for; empty: it runs on any.
  std::vector<std::string> architectures;
  int64_t added_unix_ms = 0; ///< When the folder last changed on its node.

  static constexpr auto fields() {
    return field_list{
        required("hash", &installed_skill::hash),
        required("descriptor", &installed_skill::descriptor),
        optional("version", &installed_skill::version),
        optional("architectures", &installed_skill::architectures),
        optional("added_unix_ms", &installed_skill::added_unix_ms)};
  }
};

/// Why a folder below a skill directory is no skill.
struct skill_problem {
  std::string path;    ///< File or folder it is about.
  std::string where;   ///< JSON pointer into that file, may be empty.
  std::string message; ///< What is wrong, one sentence.

  static constexpr auto fields() {
    return field_list{required("path", &skill_problem::path),
                      optional("where", &skill_problem::where),
                      required("message", &skill_problem::message)};
  }
};

/// Asks which skills the cell, or an independent node, can run.
struct skill_query {
  static constexpr const char* type = "skill_query";
  std::string operation; ///< Empty: all.

  static constexpr auto fields() {
    return field_list{optional("operation", &skill_query::operation)};
  }
};

/// One build and the nodes that have it.
struct skill_row {
  installed_skill skill;
  std::vector<std::string> nodes;
  /// When each of the nodes got it, in their order.
  std::vector<int64_t> added_unix_ms;

  static constexpr auto fields() {
    return field_list{required("skill", &skill_row::skill),
                      required("nodes", &skill_row::nodes),
                      optional("added_unix_ms", &skill_row::added_unix_ms)};
  }
};

/// A folder of a node that is no skill.
struct refused_skill {
  std::string node;
  skill_problem problem;

  static constexpr auto fields() {
    return field_list{required("node", &refused_skill::node),
                      required("problem", &refused_skill::problem)};
  }
};

struct skill_list {
  static constexpr const char* type = "skill_list";
  std::vector<skill_row> skills;
  std::vector<refused_skill> refused; ///< In the order of the nodes.

  static constexpr auto fields() {
    return field_list{required("skills", &skill_list::skills),
                      optional("refused", &skill_list::refused)};
  }
};

} // namespace roscell
