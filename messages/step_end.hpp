#pragma once

#include "messages/instance.hpp"

#include <cstddef>
#include <optional>
#include <string_view>

namespace roscell {

/// An input or output of a step.
struct step_end {
  bool is_input = true;
  size_t number = 0; ///< Among its kind, from 0.
};

/// Reads "input", "output" (the first of each), "input:1". Anything else is
/// none: a sign, a space, a leading zero, more than two digits.
std::optional<step_end> parse_step_end(std::string_view text);

/// What an instance has told of its input or output of that number, counted
/// from 0; null: nothing. It lives as long as the row.
const stream_count* input_count(const instance_row& row, std::size_t number);
const stream_count* output_count(const instance_row& row, std::size_t number);

} // namespace roscell
