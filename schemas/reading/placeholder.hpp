#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>
#include <string_view>

namespace roscell {

/// Puts a text in the place of `${name}` in all texts of a document, which is
/// what a program knows that nobody can give: the node of a task, the number of
/// a copy. `$${name}` stands for the characters themselves. Names of members
/// stay as they are, as does what has another name.
void fill_placeholder(json& document, std::string_view name,
                      const std::string& text);

/// The same, but a text that is nothing else becomes a number.
void fill_placeholder(json& document, std::string_view name, int64_t number);

/// Whether a text has that placeholder.
bool has_placeholder(const std::string& text, std::string_view name);

} // namespace roscell
