#include "schemas/document.hpp"

#include "schemas/reading/document_builder.hpp"
#include "schemas/reading/document_reader.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

/// "line 3, column 7" of the byte at `offset`, both counted from 1.
std::string position_text(std::string_view text, size_t offset) {
  auto before = text.substr(0, std::min(offset, text.size()));
  auto lines = std::count(before.begin(), before.end(), '\n');
  auto line_start = before.rfind('\n');
  if (line_start != std::string_view::npos)
    before.remove_prefix(line_start + 1);
  return "line " + std::to_string(lines + 1) + ", column "
         + std::to_string(character_count(before) + 1);
}

failure malformed(document_format format, std::string message,
                  std::string where = {}) {
  return {error_code::malformed_json,
          std::move(message),
          std::move(where),
          format == document_format::yaml
              ? "write one YAML document in UTF-8, without anchors and tags"
              : "send one JSON document in UTF-8 (RFC 8259)",
          {}};
}

bool ends_with(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size()
         && name.substr(name.size() - ending.size()) == ending;
}

} // namespace

document_format format_of(std::string_view file_name, std::string_view text) {
  if (ends_with(file_name, ".json"))
    return document_format::json;
  if (ends_with(file_name, ".yaml") || ends_with(file_name, ".yml"))
    return document_format::yaml;
  const auto first = text.find_first_not_of(" \t\r\n");
  const bool is_json = first != std::string_view::npos
                       && (text[first] == '{' || text[first] == '[');
  return is_json ? document_format::json : document_format::yaml;
}

std::variant<json, failure> parse_document(std::string_view text,
                                           document_format format,
                                           const document_limits& limits) {
  if (text.size() > limits.max_bytes)
    return malformed(format, "the document has " + std::to_string(text.size())
                                 + " bytes; at most "
                                 + std::to_string(limits.max_bytes)
                                 + " are taken");
  document_builder builder{limits};
  if (read_document(text, format, builder))
    return std::move(builder.document());
  const auto& problem = builder.problem();
  return malformed(format,
                   position_text(text, problem.offset) + ": " + problem.words,
                   builder.where());
}

std::variant<json, failure> parse_document(std::string_view text,
                                           const document_limits& limits) {
  return parse_document(text, document_format::json, limits);
}

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

/// Remembers where the deepest value stands that a pointer passes through.
class place_finder final : public document_events {
public:
  explicit place_finder(std::vector<std::string> parts)
      : parts_(std::move(parts)) {
    // nop
  }

  bool scalar(json, text_span at) override {
    arrive(at);
    return true;
  }

  bool open(json empty, text_span at) override {
    const bool is_on_way = arrive({at.begin, at.begin + 1});
    open_.push_back({empty.is_array(), is_on_way, {}, {}});
    return true;
  }

  bool key(std::string name, text_span at) override {
    open_.back().name = std::move(name);
    open_.back().key = at;
    return true;
  }

  void close() override {
    open_.pop_back();
  }

  void fail(text_problem) override {
    // The reader's answer tells it.
  }

  const text_span& found() const {
    return found_;
  }

private:
  /// An array or object that is still open.
  struct level {
    bool is_array;
    bool is_on_way; ///< The pointer passes through it.
    std::string name;
    text_span key;
    size_t index = 0;
  };

  /// A value begins; true if the pointer passes through it.
  bool arrive(const text_span& at) {
    if (open_.empty()) {
      found_ = at;
      return true;
    }
    auto& top = open_.back();
    const auto name =
        top.is_array ? std::to_string(top.index++) : std::move(top.name);
    if (!top.is_on_way || open_.size() > parts_.size()
        || parts_[open_.size() - 1] != name)
      return false;
    found_ = top.is_array ? at : top.key;
    return true;
  }

  std::vector<std::string> parts_;
  std::vector<level> open_;
  text_span found_;
};

document_place place_of(std::string_view text, const text_span& found) {
  const auto begin = std::min(found.begin, text.size());
  const auto before = text.substr(0, begin);
  const auto line_begin = before.rfind('\n') + 1; // npos + 1 is 0.
  const auto line_end = std::min(text.find('\n', begin), text.size());
  document_place result;
  result.line =
      static_cast<size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
  result.column = character_count(before.substr(line_begin)) + 1;
  const auto end = std::clamp(found.end, begin, line_end);
  result.length =
      std::max<size_t>(character_count(text.substr(begin, end - begin)), 1);
  result.text = std::string{text.substr(line_begin, line_end - line_begin)};
  return result;
}

} // namespace

std::optional<document_place> find_place(std::string_view text,
                                         document_format format,
                                         const std::string& pointer) {
  place_finder finder{parts_of(pointer)};
  if (!read_document(text, format, finder))
    return std::nullopt;
  return place_of(text, finder.found());
}

std::optional<document_problem> find_problem(std::string_view text,
                                             document_format format) {
  const document_limits limits;
  document_builder builder{limits};
  if (text.size() > limits.max_bytes || read_document(text, format, builder))
    return std::nullopt;
  const auto& [offset, words] = builder.problem();
  return document_problem{place_of(text, {offset, offset + 1}), words};
}

} // namespace roscell
