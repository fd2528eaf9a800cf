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

} // namespace roscell
