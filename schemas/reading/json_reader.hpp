#pragma once

#include "schemas/reading/document_events.hpp"

#include <string_view>

namespace roscell {

/// Gives the values of a JSON text (RFC 8259) to `events`. Nothing recurses, so
/// no nesting can exhaust the stack. False if the text is no JSON, which
/// `events` is told, or if `events` ended the reading.
bool read_json(std::string_view text, document_events& events);

} // namespace roscell
