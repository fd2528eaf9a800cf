#pragma once

#include "messages/codec/json_codec.hpp"

#include <string_view>
#include <vector>

namespace roscell {

/// A schema of the project: a file of this folder, or, of a message that only
/// nodes send to each other, made of the fields of its struct.
struct schema_entry {
  std::string_view name;    ///< The message's type, or that of a document.
  std::string_view kind;    ///< A word of `message_kind`.
  std::string_view reply;   ///< The type that answers it; or empty.
  std::string_view text;    ///< Of the file; empty: it is made.
  json (*make)() = nullptr; ///< Of its fields; null: it is a file.

  /// What is made of fields has a `type`, too, and a request a `request_id`.
  json document() const;
};

/// Those of the files; schemas/embed.cmake writes it.
std::vector<schema_entry> file_schemas();

/// Those that are made of fields.
std::vector<schema_entry> node_schemas();

/// All of them, sorted by name.
std::vector<schema_entry> all_schemas();

} // namespace roscell
