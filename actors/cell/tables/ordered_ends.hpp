#pragma once

#include "actors/core/backoff.hpp"
#include "messages/codec/described.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// That an instance was told to end, and why, as it is stored with its task: a
/// restart of the coordinator changes nothing of what its end means.
struct end_order {
  std::string instance;
  std::string reason; ///< As people are told it.
  std::string by;     ///< The task that it is preempted for; empty: none.
  int64_t priority = 5;

  static constexpr auto fields() {
    return field_list{required("instance", &end_order::instance),
                      required("reason", &end_order::reason),
                      optional("by", &end_order::by),
                      optional("priority", &end_order::priority)};
  }
};

enum class order_state {
  written,  ///< It is on disk, and nobody has been told yet.
  asked,    ///< Its node knows; it may have to be stop-safe first.
  ended,    ///< It has ended. Its room is somebody's, or will be.
  due,      ///< Nobody needs its room any more.
  starting, ///< It is being started anew.
};

/// One instance that was told to end.
struct ordered_end {
  using time_point = std::chrono::steady_clock::time_point;

  std::string task;
  end_order order;
  order_state state = order_state::written;
  bool held = true; ///< A request goes on that takes care of it.
  time_point due = time_point::max();
  time_point due_since = time_point::max(); ///< When it became due.
  /// It is tried until then to start it anew.
  time_point deadline = time_point::max();
  backoff pause = backoff{};
};

/// The preemption table: what was told to end though it had not done its work,
/// and is to be started anew once nobody needs its room, unless who has told it
/// to end does that. Pure; told the time. What of it is durable stands in the
/// tasks' records.
///
///     [*] -- its task's record has the order --> written
///     written -- it has ended by itself before --> [*]
///     written -- its node is asked to end it --> asked
///     asked -- it ends, whatever its exit code: it has failed by the order
///           --> ended
///     ended -- the request for it has come to its end, one way or the other,
///              or the coordinator was started again --> due
///     due -- there is its turn --> starting
///     starting -- it runs anew --> [*]
///     starting -- no room --> due, with a pause, up to a deadline: then [*],
///                             and it is told as stranded
///     any -- its successor has its place, or its task is gone --> [*]
class ordered_ends {
public:
  using time_point = ordered_end::time_point;

  /// The order is on disk.
  void add(const std::string& task, const end_order& order);

  /// As an earlier run of the coordinator has stored it: its node may have been
  /// asked, and nobody takes care of it.
  void restore(const std::string& task, const end_order& order, bool has_ended,
               time_point now);

  const ordered_end* find(const std::string& instance) const;

  /// Whether its end is one by order, not one of its own.
  bool is_asked(const std::string& instance) const;

  void ask(const std::string& instance);

  /// Its task knows that it has ended.
  void end(const std::string& instance, time_point now);

  /// Nobody takes care of it any more: it is started anew as soon as it has
  /// ended.
  /// @param patience for how long that is tried; 0: once.
  void let_go(const std::string& instance, time_point now,
              std::chrono::milliseconds patience = {});

  /// The same of all that was preempted for a task.
  void let_go_of(const std::string& by, time_point now);

  /// Somebody starts it anew, or it is none of the tables any more.
  void forget(const std::string& instance);

  /// A task has these orders, and no others.
  void keep_only(const std::string& task, const std::vector<end_order>& orders);

  /// Those that are to be started now, the highest priority first. They are
  /// `starting` from then on.
  std::vector<ordered_end> take_due(time_point now);

  /// It has no place. True if it is tried once more: until its deadline, or
  /// where something else goes on with it for longer.
  bool postpone(const std::string& instance, bool is_busy, time_point now);

  /// What has had no place is tried again now.
  void hurry(time_point now);

  time_point next_due() const;

  size_t size() const {
    return ends_.size();
  }

private:
  std::map<std::string, ordered_end> ends_; ///< By instance.
};

/// An instance that a node did not remove in time.
struct overdue_removal {
  std::string node;
  std::string task;
  std::string instance;
};

/// What nodes are to be asked once more to remove. Pure; told the time. A node
/// that registers anew is told what to stop, so it is forgotten here.
class removal_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// The node did not remove it, so it is asked again after a pause that
  /// grows from time to time.
  void add(const overdue_removal& what, time_point now);

  /// Those whose pause is over; they are not due again before `add`.
  std::vector<overdue_removal> take_due(time_point now);

  /// When the next pause is over; time_point::max() if none is waited for.
  time_point next_due() const;

  /// Whether it is asked for once more.
  bool has(const std::string& node, const std::string& instance) const {
    return entries_.count({node, instance}) > 0;
  }

  /// The node has removed it.
  void settle(const overdue_removal& what);
  void forget_node(const std::string& node);

  size_t size() const {
    return entries_.size();
  }

private:
  struct entry {
    std::string task;
    time_point due;
    backoff pause;
  };

  /// By node and instance.
  std::map<std::pair<std::string, std::string>, entry> entries_;
};

} // namespace roscell
