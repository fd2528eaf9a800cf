#pragma once

#include "schemas/document.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// A place in the text of a document.
struct document_place {
  size_t line = 1;   ///< Counted from 1.
  size_t column = 1; ///< Counted from 1, in characters.
  size_t length = 1; ///< Characters of what stands there, on that line.
  std::string text;  ///< The whole line.
};

/// Where a JSON pointer leads in the text of a document: to the name of a
/// member, or to an item of an array. Where it leads to nothing, as to a member
/// that is missing, the place is that of what should have it. None for a text
/// that cannot be read.
std::optional<document_place> find_place(std::string_view text,
                                         document_format format,
                                         const std::string& pointer);

/// What is wrong with a text, and where.
struct document_problem {
  document_place at;
  std::string words;
};

/// Why `parse_document` refuses a text, with its place there. None for one that
/// it takes, and for one that is too long to be looked at.
std::optional<document_problem> find_problem(std::string_view text,
                                             document_format format);

} // namespace roscell
