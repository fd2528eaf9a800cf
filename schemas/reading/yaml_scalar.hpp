#pragma once

#include "messages/codec/json_codec.hpp"

#include <optional>
#include <string>

namespace roscell {

/// What a scalar without quotes means in the core schema of YAML 1.2 (10.3.2):
/// null, a boolean, a number, or else text, as `yes` and `on` are. None for a
/// number that JSON, or a 64-bit floating-point number, cannot hold.
std::optional<json> plain_scalar(const std::string& text);

} // namespace roscell
