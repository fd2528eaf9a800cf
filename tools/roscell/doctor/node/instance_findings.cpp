#include "tools/roscell/doctor/node/instance_findings.hpp"

#include "client/instance_text.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// A share of what was asked for that a busy moment does not explain.
constexpr double beyond_asked = 1.2;

/// A share of frames that a busy moment does not explain.
constexpr double many_dropped = 0.02;

bool drops_many(const instance_metrics& x) {
  return x.dropped > 0
         && static_cast<double>(x.dropped)
                > many_dropped * static_cast<double>(x.frames + x.dropped);
}

/// Nothing, if the instance does as it should.
findings judge_instance(const instance_row& row) {
  const auto& name = row.spec.instance;
  const auto logs = "roscell logs " + shell_word(name);
  if (row.state == instance_state::failed)
    return {{judgement::broken, name + " has failed: " + row.reason,
             "its task is not whole", logs}};
  if (row.unknown_since_unix_ms != 0 || !row.problem.empty())
    return {{judgement::warning,
             name + " cannot be asked"
                 + (row.problem.empty() ? "" : ": " + row.problem),
             "whether it runs is not known",
             row.problem.empty()
                 ? "roscell describe node " + shell_word(row.node)
                 : logs}};
  if (row.state == instance_state::running
      && row.health != instance_health::good)
    return {{judgement::warning,
             name + " is " + to_string(row.health) + ": " + row.health_reason,
             "what reads its outputs gets too little", logs}};
  if (row.state == instance_state::running && !row.metrics.remark.empty())
    return {{judgement::warning, name + " gives nothing: " + row.metrics.remark,
             "what reads its outputs gets nothing", logs}};
  if (auto found = judge_use(row); !found.empty())
    return found;
  if (drops_many(row.metrics))
    return {{judgement::warning,
             name + " has dropped " + std::to_string(row.metrics.dropped)
                 + " frames and processed "
                 + std::to_string(row.metrics.frames),
             "frames come faster than it works: give it more CPU, or fewer "
             "frames",
             "roscell describe instance " + shell_word(name)}};
  return {};
}

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

findings judge_instances(const std::vector<instance_row>& rows) {
  findings result;
  for (const auto& row : rows)
    for (auto& x : judge_instance(row))
      result.push_back(std::move(x));
  return result.empty() ? findings{{judgement::ok, std::to_string(rows.size())
                                                       + " instances are well"}}
                        : result;
}

} // namespace roscell::cli
