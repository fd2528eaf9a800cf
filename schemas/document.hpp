#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
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

/// A place in the text of a document.
struct document_place {
  size_t line = 1;   ///< Counted from 1.
  size_t column = 1; ///< Counted from 1, in characters.
  size_t length = 1; ///< Characters of what stands there, on that line.
  std::string text;  ///< The whole line.
};

/// Where a JSON pointer leads in the text of a document: to the name of a
/// member, or to an item of an array. Where it leads to nothing, as to a member
/// that is missing, the place is that of what should have it. None for a text
/// that cannot be read.
std::optional<document_place> find_place(std::string_view text,
                                         document_format format,
                                         const std::string& pointer);

/// What is wrong with a text, and where.
struct document_problem {
  document_place at;
  std::string words;
};

/// Why `parse_document` refuses a text, with its place there. None for one that
/// it takes, and for one that is too long to be looked at.
std::optional<document_problem> find_problem(std::string_view text,
                                             document_format format);

template <class T, class = void>
struct has_message_type : std::false_type {};

template <class T>
struct has_message_type<T, std::void_t<decltype(T::type)>> : std::true_type {};

/// Reads a described struct from a document that has passed its schema. It
/// never throws: what the schema let through and the struct cannot hold comes
/// back as schema_violation, and another message type as unknown_type.
template <class T>
std::variant<T, failure> decode(const json& document) {
  try {
    if constexpr (has_message_type<T>::value)
      if (document.at("type") != T::type)
        return failure{error_code::unknown_type,
                       std::string{"expected a message of type "} + T::type,
                       "/type"};
    T result;
    from_json(document, result);
    return result;
  } catch (const std::exception& error) {
    return failure{error_code::schema_violation,
                   std::string{"cannot be read: "} + error.what()};
  }
}

} // namespace roscell
