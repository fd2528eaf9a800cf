#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace roscell::cli {

namespace {

/// Digits of a content hash that tell builds apart.
constexpr size_t short_hash = 12;

/// When the newest build of an operation came to a node.
using newest_builds = std::map<std::pair<std::string, std::string>, int64_t>;

int64_t added_on(const skill_row& row, size_t node) {
  return node < row.added_unix_ms.size() ? row.added_unix_ms[node] : 0;
}

newest_builds newest_of(const skill_list& skills) {
  newest_builds result;
  for (const auto& row : skills.skills)
    for (size_t i = 0; i < row.nodes.size(); ++i) {
      auto& known = result[{row.skill.descriptor.operation, row.nodes[i]}];
      known = std::max(known, added_on(row, i));
    }
  return result;
}

/// The nodes of a build, those with a newer one marked.
std::set<std::string> marked_nodes(const skill_row& row,
                                   const newest_builds& newest) {
  std::set<std::string> result;
  for (size_t i = 0; i < row.nodes.size(); ++i) {
    const auto last = newest.at({row.skill.descriptor.operation, row.nodes[i]});
    result.insert(row.nodes[i] + (added_on(row, i) < last ? "*" : ""));
  }
  return result;
}

std::string refused_view(const std::vector<refused_skill>& refused) {
  std::string text;
  for (const auto& x : refused)
    text += "refused on " + printable(x.node) + ": " + printable(x.problem.path)
            + (x.problem.where.empty() ? "" : " " + printable(x.problem.where))
            + ": " + printable(x.problem.message) + "\n";
  return text;
}

/// A version that is a hash is as long as one.
std::string short_version(const std::string& version) {
  constexpr size_t hash_digits = 64;
  return version.size() == hash_digits ? version.substr(0, short_hash)
                                       : version;
}

std::string names_of(const std::vector<std::string>& nodes) {
  return listed(std::set<std::string>{nodes.begin(), nodes.end()});
}

/// ", on its way to arm, 2 instances"
std::string uses_of(const cell_build& x) {
  return (x.coming_to.empty() ? "" : ", on its way to " + names_of(x.coming_to))
         + (x.instances == 0
                ? ""
                : ", " + std::to_string(x.instances)
                      + (x.instances == 1 ? " instance" : " instances"));
}

/// Those that come to each node that needs them, and who keeps them.
std::string builds_view(const std::vector<cell_build>& builds) {
  constexpr double bytes_of_mib = 1024 * 1024;
  std::string text;
  for (const auto& x : builds)
    text += "of the cell: " + printable(x.skill.descriptor.operation) + " "
            + printable(short_version(x.skill.version)) + ", build "
            + x.build.hash.substr(0, short_hash) + ", "
            + format_memory(static_cast<double>(x.build.bytes) / bytes_of_mib)
            + ", kept on " + names_of(x.keepers) + uses_of(x) + "\n";
  return text;
}

} // namespace

std::string skills_view(const skill_list& skills, const view_style& style) {
  table t{{{"OPERATION"},
           {"VERSION", align::left, 5},
           {"BUILT FOR", align::left, 7},
           {"MODEL"},
           {"DEPLOYMENT"},
           {"CPU", align::right, 3},
           {"MEMORY", align::right, 3},
           {"DISK", align::right, 6},
           {"GPU MEMORY", align::right, 4},
           {"BUILD", align::left, 2},
           {"NODES", align::left, 1}},
          {}};
  const auto newest = newest_of(skills);
  bool has_older = false;
  for (const auto& row : skills.skills) {
    const auto nodes = listed(marked_nodes(row, newest));
    has_older = has_older || nodes.find('*') != std::string::npos;
    const auto& made_for = row.skill.architectures;
    for (const auto& model : row.skill.descriptor.models)
      for (const auto& option : model.deployments) {
        const auto& r = option.resources;
        t.rows.push_back(
            {row.skill.descriptor.operation, short_version(row.skill.version),
             made_for.empty() ? "any"
                              : listed(std::set<std::string>{made_for.begin(),
                                                             made_for.end()}),
             model.name, option.name, format_number(r.cpu),
             format_memory(r.memory_mib), format_memory(r.disk_mib),
             r.needs_gpu() ? format_memory(r.gpu_memory_mib) : "",
             row.skill.hash.substr(0, short_hash), nodes});
      }
  }
  const auto none = skills.builds.empty() ? "no skills\n" : "";
  return (t.rows.empty() ? none : t.render(style.text))
         + (has_older ? "* has a newer build: this one is for steps that name "
                        "it\n"
                      : "")
         + builds_view(skills.builds) + refused_view(skills.refused);
}

} // namespace roscell::cli
