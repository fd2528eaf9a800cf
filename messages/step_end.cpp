#include "messages/step_end.hpp"

#include <algorithm>
#include <string>

namespace roscell {

namespace {

/// No step has a hundred ends of one kind.
constexpr size_t most_end_digits = 2;

/// The plain number that is the whole text.
std::optional<size_t> end_number(std::string_view digits) {
  const bool is_plain =
      !digits.empty() && digits.size() <= most_end_digits
      && (digits.size() == 1 || digits.front() != '0')
      && std::all_of(digits.begin(), digits.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
  if (!is_plain)
    return std::nullopt;
  size_t result = 0;
  for (const char c : digits)
    result = result * 10 + static_cast<size_t>(c - '0');
  return result;
}

} // namespace

std::optional<step_end> parse_step_end(std::string_view text) {
  const auto colon = text.find(':');
  const auto kind = text.substr(0, colon);
  if (kind != "input" && kind != "output")
    return std::nullopt;
  step_end result;
  result.is_input = kind == "input";
  if (colon == std::string_view::npos)
    return result;
  const auto number = end_number(text.substr(colon + 1));
  if (!number)
    return std::nullopt;
  result.number = *number;
  return result;
}

namespace {

const stream_count* count_at(const instance_row& row, const char* direction,
                             std::size_t number) {
  const auto end = direction + std::to_string(number);
  const auto& all = row.metrics.streams;
  const auto i = std::find_if(all.begin(), all.end(),
                              [&](const auto& x) { return x.end == end; });
  return i == all.end() ? nullptr : &*i;
}

} // namespace

const stream_count* input_count(const instance_row& row, std::size_t number) {
  return count_at(row, "input:", number);
}

const stream_count* output_count(const instance_row& row, std::size_t number) {
  return count_at(row, "output:", number);
}

} // namespace roscell
