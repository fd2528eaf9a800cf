#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

/// Text of programs that may print anything, made fit for JSON.
namespace roscell {

/// `bytes` with every byte that is no part of valid UTF-8 replaced by U+FFFD.
std::string valid_utf8(std::string_view bytes);

/// How many bytes at the start of `bytes` are valid UTF-8.
size_t valid_utf8_prefix(std::string_view bytes);

/// How many bytes at the end of `bytes` begin a character whose rest is
/// missing; at most 3.
size_t unfinished_utf8(std::string_view bytes);

// Bytes as text (RFC 4648, section 4), for JSON, which has none.

std::string to_base64(std::string_view bytes);

/// Nothing for a text that is no base64.
std::optional<std::string> from_base64(std::string_view text);

} // namespace roscell
