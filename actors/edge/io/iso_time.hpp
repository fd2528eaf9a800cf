#pragma once

#include <cstdint>
#include <string>

namespace roscell {

/// A time as ISO 8601 writes it, in UTC: "2026-11-22T17:01:02.345Z". "-" for
/// one that no calendar has.
std::string iso_time(int64_t unix_ms);

} // namespace roscell
