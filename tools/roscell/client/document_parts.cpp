#include "tools/roscell/client/document_parts.hpp"

#include <algorithm>
#include <string_view>

namespace roscell::cli {

namespace {

/// A line that begins a document. It does so in quotes and block scalars, too:
/// YAML allows no such line there.
bool is_marker(std::string_view line) {
  return line.substr(0, 3) == "---"
         && (line.size() == 3
             || std::string_view{" \t\r"}.find(line[3])
                    != std::string_view::npos);
}

bool is_empty(std::string_view line) {
  const auto first = line.find_first_not_of(" \t\r");
  return first == std::string_view::npos || line[first] == '#'
         || line.substr(0, 3) == "...";
}

} // namespace

std::vector<std::string> yaml_documents(const std::string& text) {
  std::vector<std::string> result;
  std::string document;
  bool has_value = false;
  size_t lines = 0;
  const auto finish = [&] {
    if (has_value)
      result.push_back(std::move(document));
    document.assign(lines, '\n');
    has_value = false;
  };
  for (size_t begin = 0; begin < text.size(); ++lines) {
    const auto end = std::min(text.find('\n', begin), text.size());
    const auto line = std::string_view{text}.substr(begin, end - begin);
    begin = end + 1;
    if (is_marker(line)) {
      finish();
      // What stands behind the marker belongs to the document.
      document += std::string(3, ' ') + std::string{line.substr(3)} + "\n";
      has_value = !is_empty(line.substr(3));
      continue;
    }
    has_value = has_value || !is_empty(line);
    document.append(line).push_back('\n');
  }
  finish();
  return result;
}

failure within(failure why, const std::string& at) {
  if (at.empty())
    return why;
  why.where = at + why.where;
  auto details = json::parse(why.details, nullptr, false);
  if (details.is_object() && details.contains("errors")) {
    for (auto& x : details["errors"])
      if (x.is_object())
        x["where"] = at + x.value("where", "");
    why.details = details.dump();
  }
  return why;
}

} // namespace roscell::cli
