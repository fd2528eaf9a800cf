#pragma once

#include "schemas/reading/document_events.hpp"

#include <string_view>

namespace roscell {

/// Gives the values of a YAML text to `events`, as far as JSON has them.
/// Anchors, aliases, tags, names that are no text and a second document are
/// refused, so that a text never means more values than it has bytes. False if
/// the text is refused, as one of more than 500 levels is, which `events` is
/// told, or if `events` ended the reading.
bool read_yaml(std::string_view text, document_events& events);

} // namespace roscell
