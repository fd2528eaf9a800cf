#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>
#include <string_view>

namespace roscell::cli {

/// What is wrong with a document that was refused, place by place: the file,
/// line and column, what is wrong there, and the line with a mark under the
/// place. Of many errors the first ten. Empty if the reply names no place of
/// the document. The file's name tells how it is written
/// (schemas/document.hpp).
///
///     task.yaml:4:16: there is no member "label" here; did you mean "labels"?
///       4 |   - { id: "a", label: { place: left } }
///         |                ^~~~~
std::string marked_errors(const std::string& file, std::string_view text,
                          const json& reply);

/// The line of a document that a JSON pointer leads to, with a mark under the
/// place. Empty if the text cannot be read.
std::string marked_place(const std::string& file, std::string_view text,
                         const std::string& pointer);

} // namespace roscell::cli
