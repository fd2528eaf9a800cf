#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/schema_error.hpp"

#include <string_view>
#include <vector>

namespace roscell {

/// What a schema cannot express: ids that must differ from each other, paths
/// that must stay below a folder, parts that are needed because of other parts.
/// `type` names the schema of the document, which may still break it: parts of
/// the wrong shape are passed over, so that both kinds of errors can be
/// reported together.
std::vector<schema_error> semantic_errors(std::string_view type,
                                          const json& document);

} // namespace roscell
