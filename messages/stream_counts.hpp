#pragma once

#include "messages/instance.hpp"

#include <cstddef>

namespace roscell {

/// What an instance has told of its input or output of that number, counted
/// from 0; null: nothing. It lives as long as the row.
const stream_count* input_count(const instance_row& row, std::size_t number);
const stream_count* output_count(const instance_row& row, std::size_t number);

} // namespace roscell
