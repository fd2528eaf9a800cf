#pragma once

#include "messages/inside/coordination.hpp"
#include "messages/instance.hpp"
#include "messages/session.hpp"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// How an instance has ended. What has ended is not started again by itself.
struct instance_end {
  std::string instance;
  instance_state state = instance_state::stopped; ///< Or `failed`.
  int exit_code = -1;                             ///< As in `instance_row`.
  std::string reason;
  int64_t unix_ms = 0; ///< When it ended.

  static constexpr auto fields() {
    return field_list{required("instance", &instance_end::instance),
                      required("state", &instance_end::state),
                      nullable("exit_code", &instance_end::exit_code),
                      optional("reason", &instance_end::reason),
                      required("unix_ms", &instance_end::unix_ms)};
  }
};

/// An instance that a task has placed: what it is, where, and its end.
struct deployment {
  instance_spec spec;
  std::string node; ///< Its name.
  std::optional<instance_end> end;
  bool tentative = false; ///< Takes another one's place once it runs.
};

/// What is deployed where: the one place that knows on which node an instance
/// is, and what that node has told of it. Pure; of the tasks it knows only
/// their ids. What of it is durable stands in the task's record.
class deployment_table {
public:
  /// All that a task has placed, in the order of its steps.
  void place(const std::string& task, std::vector<deployment> steps);

  /// Forgets a task, and what nodes have told of its instances.
  void forget_task(const std::string& task);

  /// What a task has placed; empty if nothing.
  const std::vector<deployment>& of_task(const std::string& task) const;

  /// Null unless a task has placed it.
  const deployment* find(const std::string& instance) const;

  /// The same, if it is on that node.
  const deployment* find(const std::string& instance,
                         const std::string& node) const;

  // -- what is on a node ----------------------------------------------------

  /// What is or will be on a node and has not ended, of deploying tasks too.
  std::vector<instance_spec> bound_to(const std::string& node) const;

  /// Ids of the tasks that have some of these, each once.
  std::vector<std::string> tasks_bound_to(const std::string& node) const;

  /// What is placed on a node that has not told of it yet: room that is held.
  std::vector<instance_spec> untold_on(const std::string& node) const;

  // -- what nodes tell ------------------------------------------------------

  /// A node has told of one instance on it. A node changes only its own rows.
  /// False if it tells of too many.
  bool note_row(const std::string& node, instance_row row);

  /// A node has told of all of its instances.
  void note_all_rows(const std::string& node,
                     const std::vector<instance_row>& rows);

  /// A node was asked what its skills say of themselves: what it has not told
  /// of a live instance is not known any more. What was told of one that has
  /// ended is final.
  void note_status_texts(const std::string& node,
                         const std::vector<instance_status_text>& texts);

  /// An instance that no task has placed is gone.
  void forget_reported(const std::string& node, const std::string& instance);

  void forget_node(const std::string& node);

  /// A node has another name from now on. Returns the tasks that have something
  /// there.
  std::set<std::string> rename_node(const std::string& from,
                                    const std::string& to);

  /// What a node has told; null if nothing.
  const instance_row* reported(const std::string& node,
                               const std::string& instance) const;

  /// Names of the nodes that have told of live instances.
  std::set<std::string> nodes_with_live() const;

  /// All rows that nodes have told, until they tell others.
  std::vector<const instance_row*> all_reported() const;

  /// The rows of a node as it has told them, in the order of their ids.
  std::vector<instance_row> rows_on(const std::string& node) const;

  /// What nodes have told of a task's instances, wanted or not.
  std::vector<instance_row> rows_of(const std::string& task) const;

  /// What is known of a node's instances: those that it has told of, those that
  /// have ended there, and, if `untold`, those that it has not told of yet.
  std::vector<instance_row> known_on(const std::string& node,
                                     bool untold) const;

  /// The same, without what only people read.
  std::vector<instance_measures> measures_on(const std::string& node,
                                             bool untold) const;

  /// What is known of an instance that a task has placed.
  instance_row row_of(const deployment& x) const;

  /// An instance is ended so that another one takes its place: its end is none
  /// of its task. `heed` takes it back; what is not deployed any more is
  /// forgotten.
  void ignore_end(const std::string& instance);
  void heed_end(const std::string& instance);

  /// Ends of a task's instances that their nodes have told of and that the
  /// placement does not know yet.
  std::vector<instance_end> untaken_ends(const std::string& task) const;

  /// The row of an instance, placed by a task or not; none if unknown.
  std::optional<instance_row> find_row(const std::string& instance) const;

private:
  /// All that is known on a node: what tasks have placed there, and what it has
  /// told of besides.
  template <class OnPlaced, class OnStray>
  void visit(const std::string& node, bool untold, OnPlaced&& on_placed,
             OnStray&& on_stray) const;

  std::map<std::string, std::vector<deployment>> by_task_;
  /// By node and instance.
  std::map<std::string, std::map<std::string, instance_row>> reported_;
  std::set<std::string> ignored_ends_; ///< By instance.
};

} // namespace roscell
