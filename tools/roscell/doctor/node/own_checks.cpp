#include "tools/roscell/doctor/node/own_checks.hpp"

#include "messages/insight/examination.hpp"
#include "tools/roscell/doctor/node/answer_problem.hpp"

#include <algorithm>
#include <future>

namespace roscell::cli {

namespace {

using asked_checks = std::shared_future<examination>;

findings found_by_node(const asked_checks& look, const std::string& name) {
  try {
    findings result;
    for (const auto& x : look.get().found)
      if (x.check == name)
        result.push_back(x);
    if (result.empty())
      result.push_back({judgement::skipped, "the node does not check it"});
    return result;
  } catch (const std::exception& e) {
    return {finding_of_failure(e, judgement::skipped)};
  }
}

} // namespace

bool is_own_check(const std::string& name) {
  constexpr const char* names[] = {"disk",    "fsync",      "descriptors",
                                   "inotify", "engine",     "gpu",
                                   "skills",  "site-token", "skill-owners"};
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

std::vector<check> own_checks(const std::shared_ptr<const node_client>& node,
                              const std::vector<check>& checks) {
  const asked_checks look = std::async(std::launch::deferred, [node] {
    return node->ask({{"type", examination_query::type}}, longest_check)
        .get<examination>();
  });
  std::vector<check> result;
  for (const auto& x : checks)
    if (is_own_check(x.name))
      result.push_back({x.name, x.area, x.about,
                        [look, name = x.name](const checked_host& /*host*/) {
                          return found_by_node(look, name);
                        }});
  return result;
}

} // namespace roscell::cli
