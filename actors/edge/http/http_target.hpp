#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// The parts of an HTTP request target such as `/v1/logs?follow=1`.
struct http_target {
  std::string path;                         ///< Percent-decoded.
  std::map<std::string, std::string> query; ///< Percent-decoded; the last
                                            ///< of equal keys counts.
};

/// Nothing if the target does not begin with '/', has a broken percent
/// escape, or decodes to a control character.
std::optional<http_target> parse_target(std::string_view target);

/// One segment of a path or one part of a query, with everything but letters,
/// digits, '-', '.', '_' and '~' escaped.
std::string percent_encode(std::string_view text);

/// A path as a header may say it: each segment so, its slashes as they are. One
/// that begins with two, which would name another host, becomes "/".
std::string encode_path(const std::string& path);

// The paths that one node asks another one for; docs/operations.md lists all.

/// Where a node's HTTP port takes sessions.
inline constexpr std::string_view session_path = "/v1/session";

/// Where nodes are told to switch. It needs no bearer token: what it takes is
/// proven in itself.
inline constexpr const char* registration_path = "/v1/registration";

/// Where those come who want an identity: "entry" or "renewal" follows.
inline constexpr std::string_view site_path = "/v1/site/";

/// Below it are the builds of skills that a node has.
inline constexpr std::string_view builds_path = "/v1/builds/";

/// Where anybody learns who a node is.
inline constexpr const char* hello_path = "/v1/hello";

} // namespace roscell
