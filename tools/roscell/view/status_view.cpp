#include "tools/roscell/view/describe/parts.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

namespace {

/// "name  value" lines, the values in one column.
class detail_list {
public:
  explicit detail_list(const view_style& style) : style_{style} {}

  void add(const std::string& name, const std::string& value) {
    if (value.empty())
      return;
    const std::string gap(name.size() < 14 ? 14 - name.size() : 1, ' ');
    auto shown = printable(value);
    const auto colour = style_.text.colour ? state_colour(shown) : "";
    if (style_.text.width > 14)
      shown = shortened(shown, style_.text.width - 14);
    text_ +=
        name + gap + colour + shown + (colour.empty() ? "" : "\x1b[0m") + "\n";
  }

  /// The same for a sentence, which is read to its end: it goes on in the next
  /// line, under its beginning.
  void add_sentence(const std::string& name, const std::string& sentence) {
    const auto width =
        style_.text.width > 40 ? style_.text.width - 14 : std::string::npos;
    auto rest = printable(sentence);
    for (auto key = name; !rest.empty(); key.clear()) {
      auto end = rest.size() <= width ? rest.size() : rest.rfind(' ', width);
      end = std::min(end, rest.size());
      text_ +=
          key + std::string(14 - key.size(), ' ') + rest.substr(0, end) + "\n";
      rest.erase(0, std::min(end + 1, rest.size()));
    }
  }

  std::string text() const {
    return text_;
  }

private:
  const view_style& style_;
  std::string text_;
};

/// "3 running, 1 failed"
std::string counted(const std::vector<instance_row>& instances) {
  std::map<std::string, size_t> counts;
  for (const auto& row : instances)
    ++counts[row.unknown_since_unix_ms == 0 ? to_string(row.state) : "unknown"];
  std::string result;
  for (const auto& [state, count] : counts)
    result +=
        (result.empty() ? "" : ", ") + std::to_string(count) + " " + state;
  return result.empty() ? "none" : result;
}

/// What the node has written to its database, and how much that is a day if it
/// has run for long enough to tell.
std::string disk_writes(const node_description& node, int64_t now_unix_ms) {
  constexpr double hour_ms = 3'600'000;
  if (node.stored_bytes <= 0)
    return {};
  const auto bytes = static_cast<double>(node.stored_bytes);
  const auto age_ms = static_cast<double>(now_unix_ms)
                      - static_cast<double>(node.started_unix_ms);
  if (node.started_unix_ms <= 0 || age_ms < hour_ms)
    return format_bytes(bytes) + " since the start";
  return format_bytes(bytes) + " ("
         + format_bytes(bytes * 24 * hour_ms / age_ms) + " a day)";
}

/// "192.168.1.10:11811: nothing listens there (tried 3 times, last 4 s ago)"
std::string join_line(const join_failure& x, int64_t now_unix_ms) {
  auto text = x.address.empty() ? std::string{"any cell"} : x.address;
  text += ": " + (x.problem.empty() ? "no answer yet" : x.problem);
  text += x.attempts == 1 ? " (tried once"
                          : " (tried " + std::to_string(x.attempts) + " times";
  return text + ", last " + format_since(x.tried_unix_ms, now_unix_ms)
         + " ago)";
}

} // namespace

std::string node_view(const node_description& node, const view_style& style) {
  detail_list details{style};
  details.add("name", node.identity.name);
  details.add("role", node.cell.empty() ? "" : role_text(node.role));
  details.add("state", to_string(node.state));
  details.add("cell", node.cell);
  details.add("coordinator", node.coordinator);
  for (const auto& x : node.joining) {
    details.add_sentence("joining", join_line(x, style.now_unix_ms));
    details.add_sentence("remedy", x.hint);
  }
  details.add("address", node.identity.address);
  details.add("architecture", node.resources.architecture);
  details.add("runtime", node.runtime);
  details.add("limits", node.limits);
  details.add("version", node.version);
  details.add("up for", format_since(node.started_unix_ms, style.now_unix_ms));
  details.add("disk written", disk_writes(node, style.now_unix_ms));
  details.add("skills", std::to_string(node.skills.size()));
  details.add("instances", counted(node.instances));
  auto text = details.text() + "\n"
              + resources_table(node.resources).render(style.text);
  if (!node.instances.empty())
    text += "\n" + instances_view({node.instances}, style);
  if (!node.actors.empty())
    text += "\n" + actors_view(node.actors, style);
  return text;
}

std::string cell_summary(const cell_description& cell,
                         const view_style& style) {
  const auto active = std::count_if(
      cell.nodes.begin(), cell.nodes.end(),
      [](const registry_row& row) { return row.state == row_state::active; });
  detail_list details{style};
  details.add("nodes", std::to_string(active) + " of "
                           + std::to_string(cell.nodes.size()) + " active");
  details.add("tasks", std::to_string(cell.tasks.size()));
  details.add("discovery", cell.discovery_server);
  auto text = "\n" + details.text();
  if (!cell.tasks.empty())
    text += "\n" + tasks_view({cell.tasks}, style);
  return text;
}

} // namespace roscell::cli
