#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/document.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell {

/// Receives the parser's events and builds the document, within its limits.
/// The interface is nlohmann's SAX interface; `false` ends the parsing.
class document_builder {
public:
  /// `bytes_read` is what the parser has read so far, for error messages.
  document_builder(const document_limits& limits, const size_t& bytes_read);

  bool null();
  bool boolean(bool value);
  bool number_integer(json::number_integer_t value);
  bool number_unsigned(json::number_unsigned_t value);
  bool number_float(json::number_float_t value, const std::string& text);
  bool string(std::string& value);
  bool binary(json::binary_t& value);
  bool start_object(size_t size);
  bool key(std::string& name);
  bool end_object();
  bool start_array(size_t size);
  bool end_array();
  bool parse_error(size_t position, const std::string& token,
                   const json::exception& error);

  json& document() {
    return root_;
  }

  /// Why the parsing ended early, in words.
  const std::string& problem() const {
    return problem_;
  }

  /// Which byte was read last when it did.
  size_t problem_offset() const {
    return problem_offset_;
  }

  /// JSON pointer to the value that was being read.
  std::string where() const;

private:
  /// An array or object that is still open.
  struct level {
    json* container;
    std::string name; ///< Of the member that is being read; objects only.
  };

  bool refuse(std::string problem);
  bool open(json empty);
  bool close();

  /// Puts a value where the document goes on; false if there are too many.
  bool add(json value);

  const document_limits limits_;
  const size_t& bytes_read_;
  json root_;
  json* last_added_ = nullptr;
  std::vector<level> open_;
  size_t values_ = 0;
  std::string problem_;
  size_t problem_offset_ = 0;
};

} // namespace roscell
