#include "tools/roscell/client/find_instance.hpp"

#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <iterator>
#include <vector>

namespace roscell::cli {

namespace {

/// The steps of a task by "TASK/STEP" too.
std::vector<instance_row> of_step(const std::vector<instance_row>& known,
                                  const std::string& word) {
  std::vector<instance_row> result;
  std::copy_if(
      known.begin(), known.end(), std::back_inserter(result),
      [&](const auto& x) { return x.spec.task + '/' + x.spec.step == word; });
  return result;
}

std::vector<instance_row> find_all(const node_client& node,
                                   const std::string& word) {
  const auto known = node.get("/v1/instances").get<instance_description>();
  if (auto found = of_step(known.instances, word); !found.empty())
    return found;
  try {
    return find_instances(known.instances, word);
  } catch (const command_error& why) {
    const auto elsewhere = why.code == exit_refused
                               ? instances_in_cell(node)
                               : std::vector<instance_row>{};
    if (elsewhere.empty())
      throw;
    auto found = of_step(elsewhere, word);
    return found.empty() ? find_instances(elsewhere, word) : found;
  }
}

} // namespace

instance_row find_instance(const node_client& node, const std::string& word) {
  auto found = find_all(node, word);
  if (found.size() > 1)
    found.erase(std::remove_if(found.begin(), found.end(),
                               [](const auto& x) { return !is_live(x.state); }),
                found.end());
  if (found.size() == 1)
    return found.front();
  std::vector<std::string> names;
  names.reserve(found.size());
  for (const auto& x : found)
    names.push_back(x.spec.instance);
  if (names.empty())
    throw command_error{exit_refused, "nothing of '" + word + "' runs now",
                        "`roscell instances` shows what runs"};
  throw command_error{exit_usage, "'" + word + "' has several instances",
                      "say which one: " + joined(names, ", ")};
}

} // namespace roscell::cli
