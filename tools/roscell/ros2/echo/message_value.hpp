#pragma once

#include "tools/roscell/ros2/echo/message_library.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace roscell::cli {

/// In the order of its definition.
using message_json_value = nlohmann::ordered_json;

/// A message as it was serialized (XCDR1 behind its encapsulation), by its
/// definition. Of sequences longer than `most_items` the rest is left out, with
/// a text in its place that says how much. Throws definition_error for a type
/// that is not known, and for bytes that are none of it.
message_json_value message_value(message_library& library,
                                 const std::string& type,
                                 const std::string& payload,
                                 std::size_t most_items);

/// The value as `ros2 topic echo` shows it: YAML, lists of numbers in one line.
std::string value_text(const message_json_value& value);

} // namespace roscell::cli
