#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/reading/document_builder.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// Gives the values of a YAML text to `events`, as far as JSON has them.
/// Anchors, aliases, tags, names that are no text and a second document are
/// refused, so that a text never means more values than it has bytes. False if
/// the text is refused, as one of more than 500 levels is, which `events` is
/// told, or if `events` ended the reading.
bool read_yaml(std::string_view text, document_events& events);

/// What a scalar without quotes means in the core schema of YAML 1.2 (10.3.2):
/// null, a boolean, a number, or else text, as `yes` and `on` are. None for a
/// number that JSON, or a 64-bit floating-point number, cannot hold.
std::optional<json> plain_scalar(const std::string& text);

} // namespace roscell
