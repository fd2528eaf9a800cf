#include "tools/roscell/view/marked_errors.hpp"

#include "messages/failure.hpp"
#include "schemas/document.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

constexpr size_t most_shown = 10;

/// Characters of a line that are shown, and how many of them before the place.
constexpr size_t shown_width = 100;
constexpr size_t shown_before = 40;

using error_at = std::pair<std::string, std::string>;

/// Pointers into the document, each with what is wrong there.
std::vector<error_at> errors_of(const failure& why) {
  std::vector<error_at> result;
  const auto details = json::parse(why.details, nullptr, false);
  if (details.is_object() && details.contains("errors"))
    for (const auto& x : details["errors"])
      if (x.is_object())
        result.emplace_back(x.value("where", ""), x.value("expected", ""));
  if (result.empty() && !why.where.empty())
    result.emplace_back(why.where, why.message);
  return result;
}

bool begins_character(char x) {
  return (static_cast<unsigned char>(x) & 0xC0) != 0x80;
}

/// `count` characters of a line from its character `first` on.
std::string characters(const std::string& line, size_t first, size_t count) {
  std::string result;
  size_t number = 0;
  for (const char x : line) {
    number += begins_character(x) ? 1 : 0;
    if (number > first + count)
      break;
    if (number > first)
      result += x == '\t' ? ' ' : x;
  }
  return result;
}

std::string marked_line(const document_place& at) {
  const auto skipped = at.column > shown_before ? at.column - shown_before : 0;
  const auto shown = printable(characters(at.text, skipped, shown_width));
  // A character may take two columns, or none.
  const auto columns_of_part = [&](size_t first, size_t count) {
    return display_width(printable(characters(at.text, first, count)));
  };
  const auto letters = at.column - 1 - skipped;
  const auto before = columns_of_part(skipped, letters);
  const auto length = std::max<size_t>(
      1, columns_of_part(at.column - 1,
                         std::min(at.length, shown_width - letters)));
  const auto number = std::to_string(at.line);
  return "  " + number + " | " + shown + "\n  "
         + std::string(number.size(), ' ') + " | " + std::string(before, ' ')
         + "^" + std::string(length - 1, '~') + "\n";
}

std::string marked_error(const std::string& file, const document_place& at,
                         const std::string& words) {
  return printable(file) + ":" + std::to_string(at.line) + ":"
         + std::to_string(at.column) + ": " + printable(words) + "\n"
         + marked_line(at);
}

struct placed_error {
  document_place at;
  std::string words;
};

/// In the order of the file, whatever the order of the checks was.
bool stands_before(const placed_error& x, const placed_error& y) {
  return std::pair{x.at.line, x.at.column} < std::pair{y.at.line, y.at.column};
}

} // namespace

std::string marked_errors(const std::string& file, std::string_view text,
                          const json& reply) {
  const auto name = file == "-" ? "standard input" : file;
  const auto format = format_of(file, text);
  const auto why = failure_from(reply);
  if (why.code == error_code::malformed_json) {
    const auto problem = find_problem(text, format);
    return problem ? marked_error(name, problem->at, problem->words) : "";
  }
  std::vector<placed_error> errors;
  for (const auto& [pointer, words] : errors_of(why)) {
    const auto at = find_place(text, format, pointer);
    if (!at)
      return {};
    errors.push_back({*at, words});
  }
  std::stable_sort(errors.begin(), errors.end(), stands_before);
  std::string result;
  for (size_t i = 0; i < errors.size(); ++i) {
    if (i == most_shown)
      return result + "and more\n";
    result += marked_error(name, errors[i].at, errors[i].words);
  }
  return result;
}

std::string marked_place(const std::string& file, std::string_view text,
                         const std::string& pointer) {
  const auto at = find_place(text, format_of(file, text), pointer);
  return at ? marked_line(*at) : std::string{};
}

} // namespace roscell::cli
