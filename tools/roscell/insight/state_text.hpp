#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>

namespace roscell::cli {

/// A JSON value for people: a line per member, what is within it indented,
/// short lists in one line.
std::string state_text(const json& value, size_t indent = 0);

} // namespace roscell::cli
