#pragma once

#include <string_view>

/// The paths that one node asks another one for; docs/operations.md lists all.
namespace roscell {

/// Where a node's HTTP port takes sessions.
inline constexpr std::string_view session_path = "/v1/session";

/// Where nodes are told to switch. It needs no bearer token: what it takes is
/// proven in itself.
inline constexpr const char* registration_path = "/v1/registration";

/// Where anybody learns who a node is.
inline constexpr const char* hello_path = "/v1/hello";

} // namespace roscell
