#pragma once

#include <string>

namespace roscell {

struct schema_rule;

/// Says of a member that a rule does not describe which one was probably meant,
/// by its spelling or by its name in other systems, or else which there are:
/// `there is no member "label" here; did you mean "labels"?`
std::string unknown_member_text(const schema_rule& rule,
                                const std::string& name);

} // namespace roscell
