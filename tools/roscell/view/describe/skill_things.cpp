#include "tools/roscell/tasks/task_view.hpp"
#include "tools/roscell/view/describe/things.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>

namespace roscell::cli {

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
                    const view_style& style) {
  const auto builds = builds_of(known, name);
  const auto& first = builds.front().skill.descriptor;
  out.detail("Engine", first.engine);
  out.detail("Program", joined(first.entry_point, " "));
  auto inner = style.text;
  inner.width = page::inner_width(inner.width);
  out.section("How it is used", skill_view(builds, inner));
}

} // namespace roscell::cli
