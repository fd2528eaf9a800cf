#pragma once

#include "actors/cell/sets/set_template.hpp"
#include "messages/task_set.hpp"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

/// What a set of tasks asks for, against what there is. Pure.
namespace roscell {

/// A node of the cell, as far as a set is concerned.
struct set_node {
  std::map<std::string, std::string> labels; ///< "node" is its name.
  bool is_unknown = false; ///< It has not told its labels yet.
  bool is_away = false;    ///< Nothing can be changed there at present.
  bool is_draining = false;
};

/// A task that one of a set would have the name of, or that is one of it.
struct set_task {
  std::string set;  ///< That it is one of; empty: none.
  std::string body; ///< `body_of` its request.
  bool is_ending = false;
  bool is_busy = false;    ///< It is being deployed or changed.
  bool is_settled = false; ///< All its steps have ended.
  bool is_of_run = false;  ///< It was asked for under the set's present run.
  std::set<std::string> nodes; ///< Where its instances are.
  /// Why its last change was put back; empty: it was not.
  std::string update_problem;
};

struct set_question {
  task_set_request request;
  std::set<std::string> stopped; ///< Nodes on which somebody has stopped it.
  std::map<std::string, set_node> nodes; ///< By name.
  std::map<std::string, set_task> tasks; ///< By name; of others, too.
};

/// What is to be done for one node.
struct set_step {
  set_change change;
  std::shared_ptr<const node_task> task; ///< Null where it stops.
  bool is_wanted = true;                 ///< The set is for that node.
  bool joins = false;   ///< What runs is asked for under the present run, too.
  bool is_held = false; ///< It waits for something else.
  std::string put_back; ///< Why its last change was; empty: it was not.
  std::string problem;  ///< Why it cannot be done; empty: it can.
};

/// The nodes that a set is for: they have its labels, are not to be empty, and
/// nobody has stopped its task there.
bool is_for(const task_set_request& set, const set_node& node);

/// One for each node that the set is for, by name, and one for each of its
/// tasks that no such node has. Of nodes whose labels nobody knows nothing is
/// said. A node on which a task of it is to stop begins another one after that.
/// @param tasks what has been worked out for nodes before.
std::vector<set_step> plan_set(const set_question& question, node_tasks& tasks);

} // namespace roscell
