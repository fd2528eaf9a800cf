#include "schemas/document.hpp"

#include "schemas/reading/document_builder.hpp"
#include "schemas/reading/document_reader.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

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

} // namespace roscell
