#include "tools/roscell/view/describe/parts.hpp"
#include "tools/roscell/view/describe/things.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>

namespace roscell::cli {

namespace {

void describe_build(page& out, const skill_row& row) {
  const auto& skill = row.skill;
  std::vector<std::string> nodes = row.nodes;
  std::sort(nodes.begin(), nodes.end());
  out.section("Build " + skill.hash.substr(0, 12),
              "version " + printable(skill.version) + "\nbuilt for "
                  + (skill.architectures.empty()
                         ? "any architecture"
                         : printable(joined(skill.architectures, ", ")))
                  + "\non " + printable(joined(nodes, ", ")));
  for (const auto& model : skill.descriptor.models) {
    table options{{{"DEPLOYMENT"},
                   {"NEEDS"},
                   {"ARCHITECTURES", align::left, 2},
                   {"LABELS", align::left, 3},
                   {"BASE IMAGE", align::left, 1}},
                  {}};
    for (const auto& x : model.deployments)
      options.rows.push_back({x.name, request_words(x.resources),
                              joined(x.architectures), pairs_words(x.labels),
                              x.base_image});
    out.section("Model " + printable(model.name), options);
    if (auto parameters = parameters_table(model.parameters);
        !parameters.rows.empty())
      out.section("Parameters of " + printable(model.name), parameters);
  }
}

} // namespace

std::vector<skill_row> builds_of(const known_cell& known,
                                 const std::string& operation) {
  std::vector<skill_row> result;
  std::copy_if(known.skills.skills.begin(), known.skills.skills.end(),
               std::back_inserter(result), [&](const auto& x) {
                 return x.skill.descriptor.operation == operation;
               });
  return result;
}

void describe_skill(page& out, const known_cell& known, const std::string& name,
                    const view_style&) {
  const auto builds = builds_of(known, name);
  const auto& first = builds.front().skill.descriptor;
  out.fact("Engine", first.engine);
  out.fact("Program", joined(first.entry_point, " "));
  out.fact("Takes", joined(first.input.data_types, ", ") + " by "
                        + joined(first.input.protocols, ", "));
  out.fact("Gives", joined(first.output.data_types, ", ") + " by "
                        + joined(first.output.protocols, ", "));
  for (const auto& row : builds)
    describe_build(out, row);
}

} // namespace roscell::cli
