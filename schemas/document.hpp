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

/// How a document is written. Machines speak JSON to each other; people may
/// write YAML instead, in files that the command line or a node reads.
enum class document_format {
  json,
  yaml,
};

/// How the document in a file of this name is written: `.json`, `.yaml` and
/// `.yml` tell; of anything else, text that begins with `{` or `[` is JSON.
document_format format_of(std::string_view file_name, std::string_view text);

/// Reads one document from untrusted bytes. Besides what its format forbids, a
/// name that stands twice in one object is refused, a number that a double
/// cannot hold, and text that is not UTF-8; of YAML also what JSON cannot say:
/// anchors, aliases, tags, names that are no text, and more documents than one.
///
/// Errors: malformed_json, with line, column, and what was expected; `where`
/// points to the value that was being read.
std::variant<json, failure> parse_document(std::string_view text,
                                           document_format format,
                                           const document_limits& limits = {});

/// Reads one JSON document.
std::variant<json, failure> parse_document(std::string_view text,
                                           const document_limits& limits = {});

} // namespace roscell
