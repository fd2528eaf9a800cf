#include "schemas/reading/document_reader.hpp"

#include "schemas/reading/yaml_reader.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

bool read_document(std::string_view text, document_format format,
                   document_events& events) {
  return format == document_format::yaml ? read_yaml(text, events)
                                         : read_json(text, events);
}

namespace {

/// nlohmann's number for "this number overflows a double".
constexpr int number_overflow = 406;

/// The bare words of the parser's message, such as "unexpected end of input;
/// expected string literal". The token that it quotes in between is left out:
/// it may be as long as the document, and need not be UTF-8.
std::string syntax_text(std::string text, const std::string& token) {
  if (auto dash = text.find(" - "); dash != std::string::npos)
    text.erase(0, dash + 3);
  const auto last_read = "; last read: '" + token + "'";
  if (auto i = text.find(last_read); i != std::string::npos)
    text.erase(i, last_read.size());
  return text;
}

/// Passes the parser's events on, with the places that it does not tell. The
/// interface is nlohmann's SAX interface.
class json_events {
public:
  json_events(std::string_view text, const size_t& bytes_read,
              document_events& to)
      : text_(text), bytes_read_(bytes_read), to_(to) {
    // nop
  }

  bool null() {
    return to_.scalar(nullptr, take_token());
  }

  bool boolean(bool value) {
    return to_.scalar(value, take_token());
  }

  bool number_integer(json::number_integer_t value) {
    return to_.scalar(value, take_token());
  }

  bool number_unsigned(json::number_unsigned_t value) {
    return to_.scalar(value, take_token());
  }

  bool number_float(json::number_float_t value, const std::string&) {
    return to_.scalar(value, take_token());
  }

  bool string(std::string& value) {
    return to_.scalar(std::move(value), take_token());
  }

  /// No JSON text holds one.
  bool binary(const json::binary_t&) {
    return false;
  }

  bool start_object(size_t) {
    return to_.open(json::object(), take_token());
  }

  bool start_array(size_t) {
    return to_.open(json::array(), take_token());
  }

  bool key(std::string& name) {
    return to_.key(std::move(name), take_token());
  }

  bool end_object() {
    return close();
  }

  bool end_array() {
    return close();
  }

  bool parse_error(size_t position, const std::string& token,
                   const json::exception& error) {
    to_.fail({position == 0 ? 0 : position - 1,
              error.id == number_overflow
                  ? "the number is too large for a 64-bit floating-point number"
                  : syntax_text(error.what(), token)});
    return false;
  }

private:
  /// What has been read since the last event, without what separates values. A
  /// number is known to end by the byte after it.
  text_span take_token() {
    constexpr std::string_view between = " \t\r\n,:";
    const auto first = text_.find_first_not_of(between, last_end_);
    const auto begin = std::min(first, text_.size());
    last_end_ = std::max(begin, std::min(bytes_read_, text_.size()));
    auto end = last_end_;
    while (end > begin + 1
           && (between.find(text_[end - 1]) != std::string_view::npos
               || (text_[begin] != '"' && is_closing(text_[end - 1]))))
      --end;
    return {begin, std::max(end, std::min(begin + 1, text_.size()))};
  }

  static bool is_closing(char x) {
    return x == ']' || x == '}';
  }

  bool close() {
    take_token();
    to_.close();
    return true;
  }

  std::string_view text_;
  const size_t& bytes_read_;
  document_events& to_;
  size_t last_end_ = 0;
};

} // namespace

bool read_json(std::string_view text, document_events& events) {
  size_t bytes_read = 0;
  json_events parser_events{text, bytes_read, events};
  const counting_iterator first{text.data(), &bytes_read};
  const counting_iterator last{text.data() + text.size(), &bytes_read};
  return json::sax_parse(first, last, &parser_events);
}

} // namespace roscell
