#pragma once

#include "schemas/document.hpp"
#include "schemas/reading/document_events.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell {

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
