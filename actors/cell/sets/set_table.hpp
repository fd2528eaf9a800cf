#pragma once

#include "actors/cell/sets/set_plan.hpp"
#include "actors/core/backoff.hpp"

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// What of a set of tasks outlives the coordinator's process.
struct task_set_record {
  std::string task;    ///< Name of the set.
  std::string request; ///< JSON of its `task_set_request`, as `body_of`.
  int64_t submitted_unix_ms = 0; ///< When it became that.
  int64_t revision = 1;          ///< Of the request, and each that was applied.
  int64_t run = 1; ///< What has ended runs once more where it is of another.
  std::vector<std::string> stopped; ///< As in `task_set_row`.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_set_record::task),
        required("request", &task_set_record::request),
        required("submitted_unix_ms", &task_set_record::submitted_unix_ms),
        required("revision", &task_set_record::revision),
        required("run", &task_set_record::run),
        optional("stopped", &task_set_record::stopped)};
  }
};

/// Under this id a task of a set is asked for.
std::string run_id(const task_set_record& record, const std::string& task);

/// The coordinator's sets of tasks. Pure; told the time. It knows what is under
/// way for each node and when what has failed is tried again; what there is to
/// do says `plan_set`, whenever something may have changed.
///
///     idle -- there is something to do --> under way
///     under way -- it is done --> idle
///     under way -- it has failed --> pausing, ever longer
///     pausing -- the time is over, the node is back, another request --> idle
class set_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  struct entry {
    task_set_record record;
    task_set_request request;
    std::shared_ptr<node_tasks> tasks; ///< What that means for nodes.
  };

  const entry* find(const std::string& set) const;
  std::vector<std::string> names() const;

  size_t size() const {
    return sets_.size();
  }

  bool is_full() const;

  /// The store has kept this. A record that cannot be read is left out.
  bool apply(const task_set_record& record);
  void forget(const std::string& set);

  // -- what is to be done -----------------------------------------------------

  /// Something may have changed: all sets are to be looked at. False if that is
  /// to be done already.
  bool hurry(time_point now);

  /// A node can do what it could not.
  void forgive(const std::string& node);

  /// Whether to look at them now; asking ends it.
  bool take_due(time_point now);
  time_point next_due() const;

  /// Of these the steps that can be taken now: nothing is held, under way or
  /// pausing, and no more than `at_once` of its tasks are being changed. One
  /// whose change was put back keeps others from being changed.
  std::vector<set_step> admit(const std::string& set,
                              const std::vector<set_step>& steps,
                              size_t being_changed, time_point now);

  void begin(const std::string& set, const set_step& step);

  /// @param problem Why it has failed; empty: it has not.
  /// @return Whether that is news.
  bool end(const std::string& set, const std::string& node,
           const std::string& problem, time_point now);

  /// The first node whose change was put back, so that no other is changed;
  /// empty: there is none.
  std::string put_back_on(const std::string& set,
                          const std::vector<set_step>& steps) const;

  /// What stands in the way of a step; empty: nothing. A change that was put
  /// back does if it was tried for the present request.
  std::string problem(const std::string& set, const set_step& step) const;

  /// How a set stands, for people; whether that is another state than the last
  /// one noted.
  bool note_counts(const task_set_row& row);

private:
  struct node_work {
    std::optional<set_action> under_way;
    std::string problem;
    time_point retry = time_point::min();
    backoff pause = backoff{};
    int64_t changed_for = 0; ///< Revision of the set; 0: none in this life.
  };

  bool was_put_back(const std::string& set, const set_step& step) const;

  struct known_set {
    entry what;
    std::map<std::string, node_work> nodes;
    std::string counts;
  };

  std::map<std::string, known_set> sets_;
  time_point due_ = time_point::max();
};

} // namespace roscell
