#pragma once

#include "actors/core/backoff.hpp"
#include "messages/life.hpp"

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// What an instance may do while nothing is heard of its node.
enum class away_rule {
  waits,  ///< It may run on for as long as it likes: nothing ends it.
  fenced, ///< It may run on until its fence ends it.
  alone,  ///< Its host may start it at any time.
};

/// Where an instance of a step may run.
struct instance_place {
  std::string task;
  std::string step;
  std::string instance;
  std::string node; ///< Its name, for people,
  std::string uuid; ///< and what tells it from another one of that name.
  away_rule rule = away_rule::waits;
  std::chrono::milliseconds after{0}; ///< Of a fenced one.
  life_policy life;                   ///< What that follows from.
  /// The last moment when its node may have heard the coordinator; none: the
  /// node is there.
  std::optional<std::chrono::steady_clock::time_point> silent_since;
};

/// Why nothing else of a step is started now.
struct start_hold {
  instance_place place;
  /// When that one has surely ended; max(): when its node says so.
  std::chrono::steady_clock::time_point until;
};

/// A step whose instance is to be placed anew: its node is lost, or its new
/// place has come to nothing.
struct abandoned_step {
  std::string task;
  std::string step;
  std::string instance;
  std::string node;                          ///< Its name,
  std::string uuid;                          ///< and whose name that was.
  std::chrono::steady_clock::time_point due; ///< Of the next attempt.
  backoff pause = backoff{};
  std::string problem;    ///< Why it has no place; empty: not tried yet.
  bool abandoned = false; ///< What returns of it is to end.
  bool stays = false;     ///< It is started on its own node only.
  /// It is not placed anew: its host starts it alone, whenever that is switched
  /// on.
  bool is_alone = false;
  bool being_placed = false; ///< An attempt goes on.
};

/// The node failure table: where each instance may run, and which steps are to
/// be placed anew. All arithmetic of fences is here: whoever starts an instance
/// asks `hold` at that moment, so it does not matter what is lost in between.
/// Pure; told the time.
///
/// A place:
///
///     [*] -- ordered, or told of as live --> there
///     there -- told as ended, removed, or not among what its node has --> [*]
///     there -- nothing is heard of its node since s --> silent
///     silent -- its node registers with it --> there
///     silent -- its node registers without it --> [*]
///     silent, fenced -- s + after_s --> [*]
///     silent, waits -- its task or its node is gone --> [*]
///     silent, alone -- somebody says that the host stays off --> [*]
///
/// A lost step:
///
///     [*] -- its node is lost --> waiting, until each place of the step that
///                                 is fenced has ended, and the pause is over
///     waiting -- its node is back, or it is wanted no more --> [*]
///     waiting -- due --> being placed (given up from the moment that its
///                        successor is written down)
///     being placed -- no room, or not up --> waiting, with a longer pause
///     being placed -- its successor runs --> [*]
class node_failures {
public:
  using time_point = std::chrono::steady_clock::time_point;

  // -- where instances may run ----------------------------------------------

  /// One is about to be started, or was told of as live: it is there. False if
  /// too many are known.
  bool order(instance_place x);

  /// Whether so many more may be started.
  bool has_room(size_t count) const;

  /// A node has told that one has ended, or that it has none of that name.
  void end(const std::string& uuid, const std::string& instance);

  /// The same of all that a task has on a node, but for these.
  void end_all(const std::string& uuid, const std::string& task,
               const std::set<std::string>& but);

  /// A node registers: it has these only.
  void node_back(const std::string& uuid, const std::set<std::string>& live);

  /// Nothing is heard of a node, whose last word came then.
  void node_lost(const std::string& uuid, time_point since);

  /// The node is none of the cell any more: its fences count from then on.
  void node_gone(const std::string& uuid, time_point now);

  void rename_node(const std::string& uuid, const std::string& name);

  /// Nothing is known any more of what its fence has surely ended.
  void forget_ended(time_point now);

  /// Nobody is left whose instances could wait for their nodes.
  void forget_waiting(const std::string& task);

  /// Somebody says that the hosts which would start them stay off.
  void forget_alone(const std::string& task);

  /// Null if it surely does not run.
  const instance_place* find(const std::string& instance, time_point now) const;

  /// What of a step may run, but for that one; none: another one may start. Of
  /// several it is the one that is to be waited for longest.
  std::optional<start_hold> hold(const std::string& task,
                                 const std::string& step, time_point now,
                                 const std::string& but = {}) const;

  /// The same of all steps of a task, without those that wait for their nodes.
  std::optional<start_hold> hold_of_task(const std::string& task,
                                         time_point now) const;

  /// All that a task has and that may run.
  std::vector<instance_place> places_of(const std::string& task,
                                        time_point now) const;

  /// UUIDs of the nodes that are taken to be there.
  std::set<std::string> nodes_there() const;

  /// How many may run.
  size_t count(time_point now) const;

  size_t size() const {
    return steps_of_.size();
  }

  // -- steps that are to be placed anew -------------------------------------

  /// Its instance is to be placed anew; known already, it stays as it is.
  void abandon(abandoned_step x);

  /// It is back, has moved, or is wanted no more.
  void forget(const std::string& instance);

  const abandoned_step* find_abandoned(const std::string& instance) const;

  /// Whether what returns of it is to end, since it is being placed elsewhere.
  bool is_abandoned(const std::string& instance) const;
  void give_up(const std::string& instance);

  /// It has no place now: tried again after a pause that grows.
  void postpone(const std::string& instance, const std::string& problem,
                time_point now);

  /// It is not due before then: it is being placed.
  void pause(const std::string& instance, time_point until);

  /// What has had no place is tried again now, once its fences have passed.
  void hurry(time_point now);

  /// Those that are to be placed now, by task.
  std::map<std::string, std::vector<abandoned_step>> due(time_point now) const;
  time_point next_due() const;

private:
  using step_key = std::pair<std::string, std::string>; ///< Task and step.

  /// When all that is fenced of a step has ended.
  time_point fenced_until(const step_key& step) const;
  time_point due_of(const abandoned_step& x) const;
  void erase(const std::string& instance);

  template <class Predicate>
  void erase_if(Predicate&& is_over);

  /// By step and instance.
  std::map<step_key, std::map<std::string, instance_place>> places_;
  std::map<std::string, step_key> steps_of_;        ///< By instance.
  std::map<std::string, abandoned_step> abandoned_; ///< The same.
};

} // namespace roscell
