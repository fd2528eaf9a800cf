#include "tools/roscell/insight/state_text.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

constexpr size_t indent_step = 2;

bool is_plain(const json& x) {
  return !x.is_structured() || x.empty();
}

std::string plain_text(const json& x) {
  if (x.is_structured())
    return "none";
  const auto text = x.is_string() ? x.get<std::string>() : x.dump();
  return text.empty() ? "-" : printable(text);
}

/// Of plain values, as one line; empty where that would be too long.
std::string one_line(const json& list) {
  constexpr size_t most_columns = 60;
  std::string result;
  for (const auto& x : list) {
    if (!is_plain(x))
      return "";
    result += (result.empty() ? "" : ", ") + plain_text(x);
  }
  return display_width(result) <= most_columns ? result : "";
}

std::string entry(const std::string& label, const json& x, size_t indent) {
  const auto begin = std::string(indent, ' ') + label;
  if (is_plain(x))
    return begin + " " + plain_text(x) + "\n";
  if (x.is_array())
    if (const auto line = one_line(x); !line.empty())
      return begin + " " + line + "\n";
  return begin + "\n" + state_text(x, indent + indent_step);
}

} // namespace

std::string state_text(const json& value, size_t indent) {
  if (is_plain(value))
    return std::string(indent, ' ') + plain_text(value) + "\n";
  std::string result;
  if (value.is_array())
    for (const auto& x : value)
      result += entry("-", x, indent);
  else
    for (const auto& [name, x] : value.items())
      result += entry(printable(name) + ":", x, indent);
  return result;
}

} // namespace roscell::cli
