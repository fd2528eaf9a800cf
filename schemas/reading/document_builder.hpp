#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/document.hpp"

#include <cstddef>
#include <string>
#include <vector>

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

/// Builds a document within its limits. What is too much, and a name that
/// stands twice in one object, is a problem like any other.
class document_builder final : public document_events {
public:
  explicit document_builder(const document_limits& limits);

  bool scalar(json value, text_span at) override;
  bool open(json empty, text_span at) override;
  bool key(std::string name, text_span at) override;
  void close() override;
  void fail(text_problem problem) override;

  json& document() {
    return root_;
  }

  /// Why the reading ended early.
  const text_problem& problem() const {
    return problem_;
  }

  /// JSON pointer to the value that was being read.
  std::string where() const;

private:
  /// An array or object that is still open.
  struct level {
    json* container;
    std::string name; ///< Of the member that is being read; objects only.
  };

  bool refuse(const text_span& at, std::string words);

  /// Puts a value where the document goes on; false if there are too many.
  bool add(json value, const text_span& at);

  const document_limits limits_;
  json root_;
  json* last_added_ = nullptr;
  std::vector<level> open_;
  size_t values_ = 0;
  text_problem problem_;
};

} // namespace roscell
