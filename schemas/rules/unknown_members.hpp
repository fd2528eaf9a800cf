#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/schema_error.hpp"

#include <vector>

namespace roscell {

struct schema_rule;

/// The members of `document`, and of what is inside it, that its schema does
/// not describe, in the order of their names: each with the member that was
/// probably meant, or with those that there are. Objects of which the schema
/// describes no member, as a model's parameters, are free.
///
/// A schema itself allows them, because a newer peer may say more. What a user
/// writes is no newer peer: a misspelt member would be dropped without a word.
std::vector<schema_error> unknown_members(const schema_rule& rule,
                                          const json& document);

} // namespace roscell
