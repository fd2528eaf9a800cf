#pragma once

namespace roscell {

/// Of this program, as other nodes and people are told.
constexpr const char* program_version = "0.1.0";

} // namespace roscell
