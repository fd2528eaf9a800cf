#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <cstddef>
#include <string_view>
#include <variant>

namespace roscell {

/// What a document from outside may cost. Parsing takes some 10 MiB at most
/// with the defaults, whatever the bytes are.
struct document_limits {
  size_t max_bytes = 1024 * 1024;
  size_t max_depth = 64;       ///< Arrays and objects inside each other.
  size_t max_values = 100'000; ///< All values together.
  size_t max_name_bytes = 256; ///< Name of an object's member.
};

/// Reads one JSON document from untrusted bytes. Nothing recurses, so no
/// nesting can exhaust the stack. Besides what JSON forbids, it refuses a name
/// that stands twice in one object, a number that a double cannot hold, and
/// text that is not UTF-8.
///
/// Errors: malformed_json, with line, column, and what was expected; `where`
/// points to the value that was being read.
std::variant<json, failure> parse_document(std::string_view text,
                                           const document_limits& limits = {});

} // namespace roscell
