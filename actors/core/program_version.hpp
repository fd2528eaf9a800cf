#pragma once

namespace roscell {

/// Of this program, as other nodes and people are told.
extern const char* const program_version;

} // namespace roscell
