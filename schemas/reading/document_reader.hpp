#pragma once

#include "schemas/document.hpp"
#include "schemas/reading/document_builder.hpp"

#include <cstddef>
#include <iterator>
#include <string_view>

namespace roscell {

/// Gives the values of a text in this format to `events`. False if the text is
/// wrong, which `events` is told, or if `events` ended the reading.
bool read_document(std::string_view text, document_format format,
                   document_events& events);

/// Gives the values of a JSON text (RFC 8259) to `events`. Nothing recurses, so
/// no nesting can exhaust the stack. False if the text is no JSON, which
/// `events` is told, or if `events` ended the reading.
bool read_json(std::string_view text, document_events& events);

/// Walks over the text and counts what was read, because the parser tells the
/// position of its own errors only.
struct counting_iterator {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  size_t* bytes_read;

  reference operator*() const {
    return *at;
  }

  counting_iterator& operator++() {
    ++at;
    ++*bytes_read;
    return *this;
  }

  bool operator==(const counting_iterator& other) const {
    return at == other.at;
  }

  bool operator!=(const counting_iterator& other) const {
    return at != other.at;
  }
};

} // namespace roscell
