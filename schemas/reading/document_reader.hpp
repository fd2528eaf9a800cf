#pragma once

#include "schemas/document.hpp"
#include "schemas/reading/document_events.hpp"

#include <string_view>

namespace roscell {

/// Gives the values of a text in this format to `events`. False if the text is
/// wrong, which `events` is told, or if `events` ended the reading.
bool read_document(std::string_view text, document_format format,
                   document_events& events);

} // namespace roscell
