#pragma once

#include "actors/cell/tables/deployment_table.hpp"
#include "actors/cell/tables/ordered_ends.hpp"
#include "messages/allocation_report.hpp"
#include "messages/failure.hpp"
#include "messages/task.hpp"
#include "messages/task_update.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// An instance that its task has given up, and that may run on where its node
/// is away.
struct left_instance {
  std::string instance;
  std::string step;
  std::string node;
  life_policy life; ///< What it does there.

  static constexpr auto fields() {
    return field_list{required("instance", &left_instance::instance),
                      required("step", &left_instance::step),
                      required("node", &left_instance::node),
                      required("life", &left_instance::life)};
  }
};

/// The requests that a task has had. The present one stands beside it.
struct revision_history {
  int64_t revision = 1;      ///< Of the present one.
  int64_t since_unix_ms = 0; ///< When it became that; 0: from the beginning.
  std::vector<task_revision> former; ///< The last ones, the newest last.

  static constexpr auto fields() {
    return field_list{
        optional("revision", &revision_history::revision),
        optional("since_unix_ms", &revision_history::since_unix_ms),
        optional("former", &revision_history::former)};
  }
};

/// How the change of a running task stands.
struct update_record {
  int64_t begun_unix_ms = 0; ///< 0: it is not being updated.
  std::string problem;       ///< Of the last one; empty: it went well.

  static constexpr auto fields() {
    return field_list{optional("begun_unix_ms", &update_record::begun_unix_ms),
                      optional("problem", &update_record::problem)};
  }
};

/// What of a task outlives the coordinator's process: its entry in the task
/// table and what it has in the deployment table, together.
struct task_record {
  std::string task;
  std::string request;  ///< JSON of the task request, to compare bodies.
  std::string accepted; ///< JSON of the reply once all steps run.
  task_state state = task_state::deploying;
  int64_t submitted_unix_ms = 0;
  std::vector<instance_spec> specs;
  std::vector<std::string> nodes;     ///< Node of each spec.
  std::vector<instance_end> ends;     ///< Of those that have ended.
  std::vector<std::string> tentative; ///< Instances of a move that goes on.
  int64_t ended_unix_ms = 0; ///< When its last step ended; 0: it goes on.
  int64_t run = 1;           ///< How often it has been started as a whole.
  /// Of the requests that are of this run, the newest last.
  std::vector<std::string> request_ids;
  std::vector<end_order> orders;   ///< Instances that were told to end.
  std::vector<left_instance> left; ///< As of when this was written.
  int64_t deadline_unix_ms = 0;    ///< As in `task_row`.
  revision_history revisions;
  update_record update;

  static constexpr auto fields() {
    return field_list{
        required("task", &task_record::task),
        required("request", &task_record::request),
        required("accepted", &task_record::accepted),
        required("state", &task_record::state),
        required("submitted_unix_ms", &task_record::submitted_unix_ms),
        required("specs", &task_record::specs),
        required("nodes", &task_record::nodes),
        optional("ends", &task_record::ends),
        optional("tentative", &task_record::tentative),
        optional("ended_unix_ms", &task_record::ended_unix_ms),
        optional("run", &task_record::run),
        optional("request_ids", &task_record::request_ids),
        optional("orders", &task_record::orders),
        optional("left", &task_record::left),
        optional("deadline_unix_ms", &task_record::deadline_unix_ms),
        optional("revisions", &task_record::revisions),
        optional("update", &task_record::update)};
  }
};

/// What the table knows of a task besides what it has deployed.
struct task_entry {
  std::string request;
  std::string set;      ///< As the request says.
  std::string accepted; ///< Without its instances; empty until placed.
  task_state state = task_state::deploying; ///< As it is stored.
  int64_t submitted_unix_ms = 0;
  bool ending = false; ///< Its instances are being removed.
  int64_t ended_unix_ms = 0;
  int64_t run = 1;
  std::vector<std::string> request_ids;
  std::vector<end_order> orders;
  int64_t deadline_unix_ms = 0;
  revision_history revisions;
  update_record update;
};

/// How a claim stands to what the table knows.
enum class claim_status {
  unknown,    ///< It may wait for the placement lock.
  other_body, ///< Another request has that id.
  ending,     ///< The task is being terminated.
  deploying,  ///< The same request is being deployed.
  accepted,   ///< The same request has been done.
  next_run,   ///< It has been done, has ended, and is asked for once more.
};

/// The coordinator's tasks. Pure. What changes of a task is proposed as a
/// record first and applied when the store has kept it.
class task_table {
public:
  const task_entry* find(const std::string& task) const;

  /// @param id Of the request; empty: it has none, and asks for no other run.
  /// @param replace Another request is the next run of a task that has ended.
  claim_status claim_status_of(const std::string& task,
                               const std::string& request,
                               const std::string& id,
                               bool replace = false) const;

  /// Whether the task's present run, or its last one, was asked for under that
  /// id.
  bool is_of_run(const std::string& task, const std::string& id) const;

  bool is_full() const;

  /// A task begins to be deployed, for the first time or once more. Nothing of
  /// it is durable yet.
  void begin(const std::string& task, const std::string& request,
             const std::string& id, int64_t now_unix_ms);

  /// Its instances are being removed from now on. False if they were already.
  bool begin_ending(const std::string& task);

  /// The store has kept this.
  void apply(const task_record& record);

  /// Its next run has come to nothing: it is as it was before that.
  void take_back(const task_record& former);

  /// The store has removed it, or never had it.
  void forget(const std::string& task);

  // -- is it still so? ------------------------------------------------------

  bool is_deploying(const std::string& task) const;
  bool is_running(const std::string& task) const;

  /// Whether nodes keep its instances.
  bool is_kept(const std::string& task) const;

  /// Settled tasks beyond the limit, the oldest first. Those of a set stay: it
  /// would start them once more.
  std::vector<std::string> superfluous() const;

  void remember_terminated(const task_terminated& reply);
  const task_terminated* find_terminated(const std::string& task) const;

  const std::map<std::string, task_entry>& entries() const {
    return entries_;
  }

private:
  std::map<std::string, task_entry> entries_;
  std::deque<task_terminated> terminated_;
};

/// The set of tasks that a request says its task is one of; empty: none.
std::string set_of(const std::string& request);

/// True for a task whose steps have all ended.
constexpr bool is_settled(task_state x) {
  return x == task_state::finished || x == task_state::failed;
}

// -- proposals --------------------------------------------------------------

/// A task as it stands in both tables.
task_record record_of(const std::string& task, const task_entry& entry,
                      const deployment_table& deployments);

/// What the record says is deployed where.
std::vector<deployment> deployments_in(const task_record& record);

/// With what was placed, in place of what an earlier run had placed.
task_record with_placement(task_record record, const task_accepted& decision,
                           std::vector<instance_spec> specs,
                           std::vector<std::string> nodes);

task_record with_state(task_record record, task_state state);

/// With a request that has found the task's run going on.
task_record with_request(task_record record, const std::string& id);

/// With ends of instances. The state follows when it was the last one.
task_record with_ends(task_record record, const std::vector<instance_end>& ends,
                      int64_t now_unix_ms);

/// With the time at which it is ended by its request's `timeout_s`, if that has
/// one and it runs. One that is set stays; an end of the task takes it away, so
/// that it is counted anew where it is started again.
task_record with_deadline(task_record record, int64_t now_unix_ms);

/// With the word that an instance is told to end, unless it has ended.
task_record with_order(task_record record, const end_order& order);
task_record without_order(task_record record, const std::string& instance);

/// An instance and the one whose place it takes.
struct replacement {
  std::string old_instance;
  instance_spec spec;
  step_allocation place;
};

/// With new instances beside the old ones.
task_record with_tentative(task_record record,
                           const std::vector<replacement>& moved);

/// With new instances instead of the old ones, but for those that have done
/// their work meanwhile.
task_record with_replaced(task_record record,
                          const std::vector<replacement>& moved);

/// With new instances instead of old ones that have ended, or are to be taken
/// for ended. The task runs.
task_record with_restarted(task_record record,
                           const std::vector<replacement>& restarted);

/// Without these instances.
task_record without(task_record record,
                    const std::vector<std::string>& instances);

/// A task has had this request until now, with these builds of its steps, and
/// has its next revision from now on.
void revise(revision_history& history, std::string former,
            std::map<std::string, std::string> builds, int64_t now_unix_ms);

/// The requests that a task has had, the present one last.
std::vector<task_revision> revisions_of(const std::string& task,
                                        const task_entry& entry,
                                        const deployment_table& deployments);

// How a task is changed while it runs. Until the last of these is kept the task
// has its former request, so that a coordinator that ends before puts back all
// that was replaced: what is tentative goes, and what was told to end is
// started again.

/// With the new instances of an update beside what runs.
task_record with_update_begun(task_record record,
                              const std::vector<replacement>& fresh,
                              int64_t now_unix_ms);

/// What an update has made of a task.
struct updated_task {
  std::string request;
  std::vector<std::string> steps; ///< Of the request, in its order.
  std::vector<replacement> fresh;
};

/// With the new request, and these steps only.
task_record with_update_done(task_record record, const updated_task& now,
                             int64_t now_unix_ms);

/// Without the new instances.
task_record with_update_reverted(task_record record,
                                 const std::vector<std::string>& fresh,
                                 const std::string& problem,
                                 int64_t now_unix_ms);

// Parameters that are changed while a step runs. That makes no new revision:
// the present request is changed in place, so that many small changes do not
// push out what a rollback goes back to.

/// Whether a request, as it is stored, has a step of that id.
bool requests_step(const std::string& request, const std::string& step);

/// With other values of some parameters of a step, in its request and in what
/// is placed of it.
task_record with_parameters(task_record record, const std::string& step,
                            const json& values);

/// As a restarted coordinator takes it up: without what was tentative. None for
/// a task that was being deployed or ended: nodes stop its instances when they
/// register.
std::optional<task_record> restored(task_record record);

/// What each node that has another name now is called, in all of a record.
task_record with_renamed(task_record record, const std::string& from,
                         const std::string& to);

/// The reply to the request, with its instances where they are now.
task_accepted reply_of(const std::string& task, const task_entry& entry,
                       const deployment_table& deployments);

} // namespace roscell
