#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Bytes as text (RFC 4648, section 4), for JSON, which has none.
namespace roscell {

std::string to_base64(std::string_view bytes);

/// Nothing for a text that is no base64.
std::optional<std::string> from_base64(std::string_view text);

} // namespace roscell
