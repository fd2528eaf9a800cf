#pragma once

#include "skills/engine/life/processing_times.hpp"

#include <cstdint>
#include <string>

namespace roscell::engine {

/// What a status says of the frames that a skill has processed: "frames=120
/// dropped=0 failed=0 median_us=85 p99_us=210 times_us=10900
/// times=119,1,0,0,0,0,0,0,0,0,0". The last are the counts of a `tally`, which
/// add up to the frames.
std::string frame_text(const processing_times& times, std::uint64_t dropped,
                       std::uint64_t failed);

} // namespace roscell::engine
