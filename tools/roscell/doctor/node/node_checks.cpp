#include "tools/roscell/doctor/node/node_checks.hpp"

#include "actors/core/program_version.hpp"
#include "client/instance_text.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/host/programs.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"
#include "tools/roscell/doctor/node/camera_checks.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace roscell::cli {

namespace {

/// What is asked of a node, and what the answer means.
struct reported_check {
  const char* name;
  const char* about;
  const char* path;
  findings (*judge)(const json& answer);
};

template <class Message, findings (*Judge)(const Message&)>
findings judge_answer_of(const json& answer) {
  return Judge(answer.get<Message>());
}

findings judge_this_version(const node_description& node) {
  return judge_version(node, program_version);
}

findings judge_described(const instance_description& answer) {
  return judge_instances(answer.instances);
}

const reported_check reported_checks[] = {
    {"node-version", "the node is of this program's version", "/v1/node",
     judge_answer_of<node_description, judge_this_version>},
    {"limits", "instances are held to what they ask for", "/v1/node",
     judge_answer_of<node_description, judge_limits>},
    {"joining", "the node is in its cell", "/v1/node",
     judge_answer_of<node_description, judge_joining>},
    {"refused-skills", "skills that the node leaves out", "/v1/node",
     judge_answer_of<node_description, judge_refused_skills>},
    {"cell", "all nodes of the cell are there", "/v1/cell",
     judge_answer_of<cell_description, judge_cell>},
    {"instances", "instances run, and keep up", "/v1/instances",
     judge_answer_of<instance_description, judge_described>},
    {"topics", "each topic has ends that match", "/v1/topics",
     judge_answer_of<topic_list, judge_topics>},
};

findings ask_and_judge(const node_client& node, const reported_check& what) {
  try {
    return what.judge(node.get(what.path));
  } catch (const std::exception& e) {
    return {finding_of_failure(e, judgement::skipped)};
  }
}

/// Nothing of them is wrong.
findings all_is_well(const std::string& seen) {
  return {{judgement::ok, seen}};
}

/// Topics on which every ROS 2 program speaks, whether somebody listens or not.
bool is_of_ros(const std::string& topic) {
  return topic == "/rosout" || topic == "/parameter_events";
}

} // namespace

std::vector<check> node_checks(std::shared_ptr<const node_client> node) {
  std::vector<check> result;
  for (const auto& x : reported_checks)
    result.push_back(
        {x.name, "node", x.about, [node, &x](const checked_host& /*host*/) {
           return ask_and_judge(*node, x);
         }});
  result.push_back(
      {"cameras", "node", "cameras publish their calibration",
       [node](const checked_host& /*host*/) { return check_cameras(*node); }});
  return result;
}

findings judge_version(const node_description& node,
                       const std::string& version) {
  const auto seen = node.identity.name + " is of version " + node.version
                    + " and runs skills by " + node.runtime;
  if (node.version == version)
    return all_is_well(seen);
  return {{judgement::warning, seen + ", this program is of " + version,
           "the node goes on as it was until it is started again",
           "sudo systemctl restart roscell"}};
}

findings judge_joining(const node_description& node) {
  if (node.joining.empty())
    return all_is_well(
        node.cell.empty() ? node.identity.name + " is in no cell and tries none"
                          : node.identity.name + " is in cell " + node.cell);
  const auto& x = node.joining.front();
  const auto where = x.address.empty() ? "any visible cell" : x.address;
  return {{judgement::broken,
           node.identity.name + " does not come into " + where + ": "
               + (x.problem.empty() ? "it still tries" : x.problem),
           x.hint, "roscell status"}};
}

findings judge_refused_skills(const node_description& node) {
  return judge_skills(node.skills.size(), node.refused_skills);
}

findings judge_topics(const topic_list& topics) {
  findings result;
  std::set<std::string> unread, unwritten;
  for (const auto& x : topics.topics) {
    for (const auto& why : x.mismatches)
      result.push_back({judgement::broken, x.topic + ": " + why,
                        "nothing arrives there: let the step's "
                        "ros2_reliability or ros2_durability be that of the "
                        "other end",
                        "roscell topics"});
    if (is_of_ros(x.topic))
      continue;
    if (x.readers.empty())
      unread.insert(x.topic);
    if (x.writers.empty())
      unwritten.insert(x.topic);
  }
  if (!unwritten.empty())
    result.push_back({judgement::warning, "nobody writes " + listed(unwritten),
                      "who reads it waits", "roscell topics"});
  if (!unread.empty())
    result.push_back({judgement::warning, "nobody reads " + listed(unread),
                      "what is written there costs time for nothing, or its "
                      "reader is away, or of another type",
                      "roscell topics"});
  return result.empty() ? all_is_well(std::to_string(topics.topics.size())
                                      + " topics have ends that match")
                        : result;
}

findings judge_cell(const cell_description& cell) {
  findings result;
  for (const auto& x : cell.nodes)
    if (x.state == row_state::lost || x.state == row_state::expected)
      result.push_back(
          {judgement::broken,
           x.identity.name + " is " + to_string(x.state)
               + (x.reason.empty() ? "" : ": " + x.reason),
           "what ran there is not known, and nothing new is placed "
           "there",
           "roscell describe node " + shell_word(x.identity.name)});
  return result.empty() ? all_is_well(std::to_string(cell.nodes.size())
                                      + " nodes are in cell " + cell.cell)
                        : result;
}

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
