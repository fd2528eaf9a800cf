#include "tools/roscell/doctor/node/node_checks.hpp"

#include "actors/core/program_version.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/host/programs.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"
#include "tools/roscell/doctor/node/camera_checks.hpp"
#include "tools/roscell/doctor/node/instance_findings.hpp"
#include "tools/roscell/view/format.hpp"

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

} // namespace roscell::cli
