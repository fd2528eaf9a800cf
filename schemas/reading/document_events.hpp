#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstddef>
#include <string>

namespace roscell {

/// Bytes of a text: the first one, and the one after the last.
struct text_span {
  size_t begin = 0;
  size_t end = 0;
};

/// What is wrong with a text, and at which byte.
struct text_problem {
  size_t offset = 0;
  std::string words;
};

/// Receives the values of a document in the order of its text, each with its
/// place there. `false` ends the reading.
class document_events {
public:
  document_events() = default;
  document_events(const document_events&) = delete;
  document_events& operator=(const document_events&) = delete;
  virtual ~document_events() = default;

  /// A value that holds no others.
  virtual bool scalar(json value, text_span at) = 0;

  /// An array or object begins; `empty` is one without values. Its place is
  /// that of its first byte.
  virtual bool open(json empty, text_span at) = 0;

  /// The name of a member, whose value comes next.
  virtual bool key(std::string name, text_span at) = 0;

  /// The array or object that was opened last ends.
  virtual void close() = 0;

  /// The text is none of its format.
  virtual void fail(text_problem problem) = 0;
};

} // namespace roscell
