#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <sstream>
#include <vector>

namespace roscell::cli {

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in{text};
  for (std::string line; std::getline(in, line);)
    result.push_back(line);
  return result;
}

} // namespace

std::string instances_view(const instance_description& instances,
                           const view_style& style) {
  return or_nothing(table_of(instance_columns(), instances.instances, style),
                    "instances", style);
}

std::string instance_view(const instance_description& instances,
                          const view_style& style) {
  auto text = instances_view(instances, style);
  for (const auto& row : instances.instances) {
    if (const auto words = safety_text(row); !words.empty())
      text += "\nmay be ended: " + words + "\n";
    if (row.restarts > 0)
      text += "\nstarted again " + std::to_string(row.restarts)
              + " times; its last ends:\n";
    for (const auto& end : row.ends) {
      text += "  " + format_since(end.unix_ms, style.now_unix_ms)
              + " ago: " + printable(end.reason) + "\n";
      for (const auto& line : lines_of(end.log))
        text += "      " + printable(line) + "\n";
    }
  }
  return text;
}

} // namespace roscell::cli
