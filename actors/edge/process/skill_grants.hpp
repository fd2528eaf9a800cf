#pragma once

#include "messages/skill.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

/// What a node's configuration lets skills have beyond an ordinary program's
/// due. Pure: nothing is looked up on the host.
namespace roscell {

/// One thing that is granted.
struct skill_grant {
  enum class sort { capability, user, fifo, rr, nice };

  std::string skill; ///< Its operation, or "*".
  sort what = sort::capability;
  std::string name;  ///< Of the capability or the user.
  int64_t bound = 0; ///< The highest priority, or the lowest nice value.
};

class skill_grants {
public:
  /// Reads lines "SKILL=WHAT[,WHAT...]". WHAT is `capability:NAME`,
  /// `user:NAME`, `scheduling:fifo:PRIORITY`, `scheduling:rr:PRIORITY` or
  /// `scheduling:nice:VALUE`. Else the sentence that says what is wrong.
  static std::variant<skill_grants, std::string>
  parse(const std::vector<std::string>& lines);

  bool allows_capability(const std::string& skill,
                         const std::string& name) const;

  /// Whom its processes belong to; empty: the node's user. What is said of the
  /// skill itself counts more than what is said of all.
  std::string user_of(const std::string& skill) const;

  /// What takes nothing from others is everybody's.
  bool allows_scheduling(const std::string& skill,
                         const scheduling_request& request) const;

  /// What a deployment of the skill wants that is not granted, each as the WHAT
  /// that would grant it.
  std::vector<std::string> missing(const std::string& skill,
                                   const deployment_option& wanted) const;

  const std::vector<skill_grant>& all() const {
    return grants_;
  }

private:
  std::vector<skill_grant> grants_;
};

using shared_skill_grants = std::shared_ptr<const skill_grants>;

/// Why a node is no place for a deployment, of which `what` is missing:
/// "skill 'x' wants capability NET_RAW, which node 'n' does not grant it: grant
/// = x=capability:NET_RAW".
std::string refusal_text(const std::string& skill, const std::string& node,
                         const std::string& what);

} // namespace roscell
