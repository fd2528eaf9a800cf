#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

/// Words about JSON values, short enough for one line of an error message.
namespace roscell {

/// Number of characters (code points) of a UTF-8 text.
size_t character_count(std::string_view utf8);

/// The first `max_characters` of `text` in quotes, escaped as in JSON, with an
/// ellipsis where something was cut off. Bytes that are no UTF-8 are replaced,
/// so the result can always be put into a JSON reply.
std::string in_quotes(std::string_view text, size_t max_characters = 40);

/// What is left of a range's ends that are infinite: ` from 0 to 100`, ` of at
/// least 1`, or nothing.
std::string bounds_text(double minimum, double maximum);

/// What is said of a member that has to be there and is not: `expected "id", a
/// name, but it is missing`.
std::string absence_text(std::string_view name, const std::string& expected);

/// What a value is: `the number 7`, `"a b"`, `an array of 3 items`.
std::string shown_value(const json& value);

/// The one of `words` that `typed` was probably meant to be: the nearest in
/// insertions, deletions and replacements, if at most a third of its characters
/// differ. Empty if none is near, or if `typed` is longer than any word.
std::string_view closest_word(std::string_view typed,
                              const std::vector<std::string_view>& words);

/// What is said of a name that is none of the known ones: `there is no variable
/// "rat_hz"; did you mean "rate_hz"?`, or which there are.
std::string unknown_name_text(const std::string& kind, std::string_view name,
                              const std::vector<std::string_view>& known);

} // namespace roscell
