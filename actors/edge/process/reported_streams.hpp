#pragma once

#include "messages/instance.hpp"

#include <string_view>
#include <vector>

namespace roscell {

/// Reads what follows ROSCELL_STREAMS=, see `notification`. Empty when a part
/// of it makes no sense: of a line that is broken no value can be trusted.
std::vector<stream_metrics> read_streams(std::string_view text);

/// Reads what follows ROSCELL_FRAMES=, in the same way.
std::vector<stream_count> read_frames(std::string_view text);

} // namespace roscell
