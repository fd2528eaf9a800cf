#include "tools/roscell/doctor/node/use_findings.hpp"

#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// A share of what was asked for that a busy moment does not explain.
constexpr double beyond_asked = 1.2;

} // namespace

findings judge_use(const instance_row& row) {
  const auto& use = row.metrics.use;
  const auto& asked = row.spec.resources;
  const auto look =
      "roscell describe instance " + shell_word(row.spec.instance);
  if (use.memory_kills > 0)
    return {{judgement::warning,
             row.spec.instance + " has lost " + std::to_string(use.memory_kills)
                 + " processes, which were ended for memory",
             "give it more: memory_mib of its deployment", look}};
  if (takes_too_much(row))
    return {{judgement::warning,
             row.spec.instance + " takes " + memory_text(row)
                 + (use.memory_limit_mib < 0 ? ", which it has asked for" : ""),
             use.memory_limit_mib < 0
                 ? "others are placed where it takes their room: raise "
                   "memory_mib of its deployment"
                 : "it is ended when it wants more: raise memory_mib of its "
                   "deployment",
             look}};
  if (asked.cpu > 0 && use.cpu > beyond_asked * asked.cpu)
    return {{judgement::warning,
             row.spec.instance + " uses " + cpu_text(row)
                 + " cores that it has asked for",
             "others are placed where it takes their time: raise cpu of its "
             "deployment",
             look}};
  return {};
}

findings judge_limits(const node_description& node) {
  if (node.limits.rfind("none", 0) != 0)
    return {
        {judgement::ok,
         "instances of " + node.identity.name + " have limits: "
             + (node.limits.empty() ? "of an earlier version" : node.limits)}};
  return {{judgement::warning,
           "instances of " + node.identity.name + " have no limits: "
               + node.limits.substr(std::min<size_t>(6, node.limits.size())),
           "one that takes too much memory takes it from all others; the unit "
           "of the package has a place for cgroups, and so has root",
           "roscell node --help"}};
}

} // namespace roscell::cli
