#include "actors/edge/history/event_lines.hpp"

#include "actors/edge/history/limits.hpp"
#include "schemas/decode.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <variant>

namespace roscell {

namespace {

/// As the schema has it.
constexpr size_t most_subject_bytes = 256;

std::string plain_line_of(const event& x) {
  return std::to_string(x.sequence) + ' '
         + message_json(x).dump(-1, ' ', false, json::error_handler_t::replace)
         + '\n';
}

} // namespace

std::string line_of(const event& x) {
  auto result = plain_line_of(x);
  if (x.subject.size() <= most_subject_bytes
      && result.size() <= limits::history::line_bytes)
    return result;
  auto fitting = x;
  fitting.subject.resize(std::min(x.subject.size(), most_subject_bytes));
  fitting.subject.resize(fitting.subject.size()
                         - unfinished_utf8(fitting.subject));
  if (result.size() > limits::history::line_bytes)
    fitting.data = json{{"left_out_bytes", x.data.size()}}.dump();
  return plain_line_of(fitting);
}

std::optional<uint64_t> number_of(std::string_view line) {
  uint64_t result = 0;
  const auto* end = line.data() + line.size();
  const auto [rest, error] = std::from_chars(line.data(), end, result);
  if (error != std::errc{} || rest == end || *rest != ' ' || result == 0)
    return std::nullopt;
  return result;
}

std::optional<event> event_of(std::string_view line) {
  const auto number = number_of(line);
  if (!number || line.size() > limits::history::line_bytes)
    return std::nullopt;
  line.remove_prefix(line.find(' ') + 1);
  auto parsed = parse_document(line);
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || validate_message(*document, {message_kind::event}))
    return std::nullopt;
  auto decoded = decode<event>(*document);
  auto* result = std::get_if<event>(&decoded);
  if (result == nullptr || result->sequence != *number)
    return std::nullopt;
  return std::move(*result);
}

} // namespace roscell
