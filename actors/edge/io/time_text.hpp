#pragma once

#include <cstdint>
#include <string>

/// Times as text; "-" for one that no calendar has.
namespace roscell {

/// As ISO 8601 writes it, in UTC: "2026-11-22T17:01:02.345Z".
std::string iso_time(int64_t unix_ms);

/// In the time of this place: "2026-11-21 14:03:07.250".
std::string local_time(int64_t unix_ms);

} // namespace roscell
