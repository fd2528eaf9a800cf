#pragma once

#include "messages/codec/json_codec.hpp"

namespace roscell::cli {

/// What a node that stands on paper only may leave out: it uses nothing, has no
/// GPU, label or device, and no unified memory. What is wrong with the document
/// is for the schema to say.
void complete_paper_node(json& node);

} // namespace roscell::cli
