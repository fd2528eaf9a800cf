#pragma once

#include <cstddef>
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

} // namespace roscell
