#include "schemas/document.hpp"

#include "schemas/counting_iterator.hpp"
#include "schemas/document_builder.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// "line 3, column 7" of the byte at `offset`, both counted from 1.
std::string position_words(std::string_view text, size_t offset) {
  auto before = text.substr(0, std::min(offset, text.size()));
  auto lines = std::count(before.begin(), before.end(), '\n');
  auto line_start = before.rfind('\n');
  if (line_start != std::string_view::npos)
    before.remove_prefix(line_start + 1);
  return "line " + std::to_string(lines + 1) + ", column "
         + std::to_string(character_count(before) + 1);
}

failure malformed(std::string message, std::string where = {}) {
  return {error_code::malformed_json,
          std::move(message),
          std::move(where),
          "send one JSON document in UTF-8 (RFC 8259)",
          {}};
}

} // namespace

std::variant<json, failure> parse_document(std::string_view text,
                                           const document_limits& limits) {
  if (text.size() > limits.max_bytes)
    return malformed("the document has " + std::to_string(text.size())
                     + " bytes; at most " + std::to_string(limits.max_bytes)
                     + " are taken");
  size_t bytes_read = 0;
  document_builder builder{limits, bytes_read};
  counting_iterator first{text.data(), &bytes_read};
  counting_iterator last{text.data() + text.size(), &bytes_read};
  if (json::sax_parse(first, last, &builder))
    return std::move(builder.document());
  return malformed(position_words(text, builder.problem_offset()) + ": "
                       + builder.problem(),
                   builder.where());
}

} // namespace roscell
