#pragma once

#include <cstddef>
#include <iterator>
#include <string_view>

namespace roscell {

/// One file of this folder, as the build embeds it.
struct embedded_schema {
  std::string_view name;  ///< The file's name up to ".schema.json".
  std::string_view kind;  ///< Its `x-kind`: what it describes.
  std::string_view reply; ///< Its `x-reply`: the type that answers; or empty.
  std::string_view text;  ///< The schema itself.
};

/// A view of the table that schemas/embed.cmake writes, sorted by name.
struct embedded_schema_list {
  const embedded_schema* first;
  const embedded_schema* last;

  const embedded_schema* begin() const {
    return first;
  }

  const embedded_schema* end() const {
    return last;
  }

  size_t size() const {
    return static_cast<size_t>(last - first);
  }
};

embedded_schema_list embedded_schemas();

} // namespace roscell
