#pragma once

#include <string_view>

namespace roscell {

/// Where a node's HTTP port takes sessions.
inline constexpr std::string_view session_path = "/v1/session";

} // namespace roscell
