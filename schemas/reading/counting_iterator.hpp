#pragma once

#include <cstddef>
#include <iterator>

namespace roscell {

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
