#include "schemas/document_place.hpp"

#include "messages/codec/json_codec.hpp"
#include "schemas/counting_iterator.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// The parts of a pointer, unescaped (RFC 6901).
std::vector<std::string> parts_of(const std::string& pointer) {
  std::vector<std::string> result;
  json::json_pointer rest{pointer};
  for (; !rest.empty(); rest = rest.parent_pointer())
    result.push_back(rest.back());
  std::reverse(result.begin(), result.end());
  return result;
}

/// Receives the parser's events and remembers where the deepest value stands
/// that a pointer passes through. The interface is nlohmann's SAX interface.
class place_finder {
public:
  place_finder(std::string_view text, std::vector<std::string> parts,
               const size_t& bytes_read)
      : text_(text), parts_(std::move(parts)), bytes_read_(bytes_read) {
    // nop
  }

  /// Of the first and after the last byte.
  std::pair<size_t, size_t> found{0, 0};

  bool null() {
    return value();
  }

  bool boolean(bool) {
    return value();
  }

  bool number_integer(json::number_integer_t) {
    return value();
  }

  bool number_unsigned(json::number_unsigned_t) {
    return value();
  }

  bool number_float(json::number_float_t, const std::string&) {
    return value();
  }

  bool string(const std::string&) {
    return value();
  }

  bool binary(const json::binary_t&) {
    return value();
  }

  bool start_object(size_t) {
    return open(false);
  }

  bool start_array(size_t) {
    return open(true);
  }

  bool end_object() {
    return close();
  }

  bool end_array() {
    return close();
  }

  bool key(const std::string& name) {
    auto& level = open_.back();
    level.name = name;
    level.key = take_token();
    return true;
  }

  bool parse_error(size_t, const std::string&, const json::exception&) {
    return false;
  }

private:
  /// An array or object that is still open.
  struct level {
    bool is_array;
    bool is_on_way; ///< The pointer passes through it.
    std::string name;
    std::pair<size_t, size_t> key;
    size_t index = 0;
  };

  /// What has been read since the last event, without what separates values. A
  /// number is known to end by the byte after it.
  std::pair<size_t, size_t> take_token() {
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

  /// A value begins; true if the pointer passes through it.
  bool arrive(const std::pair<size_t, size_t>& token) {
    if (open_.empty()) {
      found = token;
      return true;
    }
    auto& top = open_.back();
    const auto name =
        top.is_array ? std::to_string(top.index++) : std::move(top.name);
    if (!top.is_on_way || open_.size() > parts_.size()
        || parts_[open_.size() - 1] != name)
      return false;
    found = top.is_array ? token : top.key;
    return true;
  }

  bool value() {
    arrive(take_token());
    return true;
  }

  bool open(bool is_array) {
    const bool is_on_way = arrive(take_token());
    open_.push_back({is_array, is_on_way, {}, {}});
    return true;
  }

  bool close() {
    take_token();
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  std::vector<std::string> parts_;
  const size_t& bytes_read_;
  std::vector<level> open_;
  size_t last_end_ = 0;
};

document_place place_of(std::string_view text,
                        const std::pair<size_t, size_t>& found) {
  const auto before = text.substr(0, found.first);
  const auto line_begin = before.rfind('\n') + 1; // npos + 1 is 0.
  const auto line_end = std::min(text.find('\n', found.first), text.size());
  document_place result;
  result.line =
      static_cast<size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  result.column = character_count(before.substr(line_begin)) + 1;
  const auto end = std::min(found.second, line_end);
  result.length = std::max<size_t>(
      character_count(text.substr(found.first, end - found.first)), 1);
  result.text = std::string{text.substr(line_begin, line_end - line_begin)};
  return result;
}

} // namespace

std::optional<document_place> find_place(std::string_view text,
                                         const std::string& pointer) {
  size_t bytes_read = 0;
  place_finder finder{text, parts_of(pointer), bytes_read};
  const counting_iterator first{text.data(), &bytes_read};
  const counting_iterator last{text.data() + text.size(), &bytes_read};
  if (!json::sax_parse(first, last, &finder))
    return std::nullopt;
  return place_of(text, finder.found);
}

} // namespace roscell
