#pragma once

#include "messages/event.hpp"
#include "messages/instance.hpp"

#include <map>
#include <string>
#include <vector>

namespace roscell {

/// One step of a pipeline: an operation, how to do it, and its data.
struct task_step {
  std::string id;
  std::string operation;
  std::string model;
  std::string deployment; ///< Empty: any deployment option of the model.
  /// The first digits of a build's hash; empty: on each node the one that was
  /// added last.
  std::string build;
  std::vector<io_endpoint> input;
  std::vector<io_endpoint> output;
  std::string parameters; ///< JSON object that overrides the model's.
  std::map<std::string, std::string> labels; ///< Labels the node must have.
  bool external = false; ///< Each topic that it reads is `external`.
  /// JSON objects with some of the members of `restart_policy`,
  /// `node_loss_policy` and `health_policy`: the rest is as its skill says.
  std::string restart;
  std::string on_node_loss;
  std::string health;
  double safe_timeout_s = 0; ///< 0: as its skill says.
  int64_t priority = 5;      ///< 0 to 9.
  std::string on_boot; ///< A word of `boot_action`; empty: as its skill says.
  /// Environment variables of its program, over those of its skill.
  std::map<std::string, std::string> env;
  std::vector<std::string> arguments; ///< Of its program, after its skill's.
  /// Its program is started so often, as steps "<id>-1", "<id>-2" and so on;
  /// in their texts `${copy}` is the number.
  int64_t copies = 1;
  bool anywhere = false; ///< In a set of tasks: it may run on another node.
  std::vector<std::string> secrets; ///< That its program can read as files.
  /// Environment variables, each with the name of the secret that is its value.
  std::map<std::string, std::string> secret_env;

  static constexpr auto fields() {
    return field_list{required("id", &task_step::id),
                      required("operation", &task_step::operation),
                      required("model", &task_step::model),
                      optional("deployment", &task_step::deployment),
                      optional("build", &task_step::build),
                      one_or_many("input", &task_step::input),
                      one_or_many("output", &task_step::output),
                      raw_json("parameters", &task_step::parameters),
                      optional("labels", &task_step::labels),
                      optional("external", &task_step::external),
                      raw_json("restart", &task_step::restart),
                      raw_json("on_node_loss", &task_step::on_node_loss),
                      raw_json("health", &task_step::health),
                      optional("safe_timeout_s", &task_step::safe_timeout_s),
                      optional("priority", &task_step::priority),
                      optional("on_boot", &task_step::on_boot),
                      optional("env", &task_step::env),
                      optional("arguments", &task_step::arguments),
                      optional("copies", &task_step::copies),
                      optional("anywhere", &task_step::anywhere),
                      optional("secrets", &task_step::secrets),
                      optional("secret_env", &task_step::secret_env)};
  }
};

/// What instances of lower priority do where a task does not fit.
enum class preemption {
  none, ///< They stay.
  show, ///< They stay, and the refusal names those that would have to go.
  yes,  ///< They are preempted.
};

constexpr auto enum_words(preemption) {
  return std::array<std::string_view, 3>{"none", "show", "yes"};
}

/// How a task is changed while it runs.
struct update_policy {
  /// How long what was replaced is to run well before the next step is.
  double healthy_for_s = 10;

  static constexpr auto fields() {
    return field_list{optional("healthy_for_s", &update_policy::healthy_for_s)};
  }
};

/// Allocates and starts the steps of a pipeline. Answered by `task_accepted`
/// once all of them run. A second one with the same steps starts again what has
/// failed, and is told how the task stands; under a new id it is the next run
/// of a task that has ended.
struct task_request {
  static constexpr const char* type = "task_request";
  std::string task;
  std::vector<task_step> pipeline;
  preemption preempt = preemption::none;
  bool force = false; ///< What is preempted is not waited for to be stop-safe.
  /// How long it may run, from when all its steps do; 0: for ever.
  double timeout_s = 0;
  std::map<std::string, std::string> labels; ///< To tell tasks apart by.
  update_policy update;
  /// Where its task has ended, and had another request, this is its next run.
  bool replace = false;
  std::string set; ///< That it is one of; empty: none.
  /// Under one id a task runs once. Empty: it has none.
  std::string request_id;

  static constexpr auto fields() {
    return field_list{required("task", &task_request::task),
                      required("pipeline", &task_request::pipeline),
                      optional("preempt", &task_request::preempt),
                      optional("force", &task_request::force),
                      optional("timeout_s", &task_request::timeout_s),
                      optional("labels", &task_request::labels),
                      optional("update", &task_request::update),
                      optional("replace", &task_request::replace),
                      optional("set", &task_request::set),
                      optional("request_id", &task_request::request_id)};
  }
};

/// Allocates only; answered by `task_plan`.
struct task_plan_query {
  static constexpr const char* type = "task_plan_query";
  std::string task;
  std::vector<task_step> pipeline;
  std::vector<std::string> without; ///< Nodes to be thought away.
  std::vector<node_resources>
      with;        ///< Nodes to be thought of, with all skills.
  std::string why; ///< A step whose best alternative is asked for.
  /// Where it does not fit, instances of lower priority are thought away.
  bool preempt = false;

  static constexpr auto fields() {
    return field_list{required("task", &task_plan_query::task),
                      required("pipeline", &task_plan_query::pipeline),
                      optional("without", &task_plan_query::without),
                      optional("with", &task_plan_query::with),
                      optional("why", &task_plan_query::why),
                      optional("preempt", &task_plan_query::preempt)};
  }
};

/// A placed instance of a step.
struct placed_instance {
  std::string step;
  std::string instance;
  std::string node;

  static constexpr auto fields() {
    return field_list{required("step", &placed_instance::step),
                      required("instance", &placed_instance::instance),
                      required("node", &placed_instance::node)};
  }
};

/// An instance that is preempted for a task of higher priority.
struct preempted_instance {
  std::string instance;
  std::string task;
  std::string step;
  std::string node;
  int64_t priority = 0; ///< 0 to 9; lower than that of each step of the task.

  static constexpr auto fields() {
    return field_list{required("instance", &preempted_instance::instance),
                      required("task", &preempted_instance::task),
                      required("step", &preempted_instance::step),
                      required("node", &preempted_instance::node),
                      required("priority", &preempted_instance::priority)};
  }
};

/// Removes the instances of a task everywhere.
struct task_termination {
  static constexpr const char* type = "task_termination";
  std::string task;
  bool force = false; ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("task", &task_termination::task),
                      optional("force", &task_termination::force)};
  }
};

/// Reply to `task_termination`. It does not wait for what is not stop-safe yet:
/// that is named, ends by itself, and the event `task_terminated` follows.
struct task_terminated {
  static constexpr const char* type = "task_terminated";
  std::string task;
  std::vector<std::string> instances; ///< Those that were removed.
  /// Nodes that are away: they remove theirs when they come back.
  std::vector<std::string> pending_nodes;
  std::vector<safety_wait> waiting; ///< These are not gone yet.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_terminated::task),
        required("instances", &task_terminated::instances),
        optional("pending_nodes", &task_terminated::pending_nodes),
        optional("waiting", &task_terminated::waiting)};
  }
};

/// Ends instances of a task that runs and starts them again where they are;
/// what has ended is started where it fits.
struct task_restart {
  static constexpr const char* type = "task_restart";
  std::string task;
  std::string instance; ///< Empty: all of the task.
  bool force = false;   ///< Nothing is waited for to be stop-safe.

  static constexpr auto fields() {
    return field_list{required("task", &task_restart::task),
                      optional("instance", &task_restart::instance),
                      optional("force", &task_restart::force)};
  }
};

struct task_restarted {
  static constexpr const char* type = "task_restarted";
  std::string task;
  std::vector<placed_instance> instances; ///< The new ones.

  static constexpr auto fields() {
    return field_list{required("task", &task_restarted::task),
                      required("instances", &task_restarted::instances)};
  }
};

enum class task_state {
  deploying,
  running,
  degraded, ///< Something of it does not run, or nobody knows.
  terminating,
  finished, ///< Every step has ended with 0.
  failed,   ///< Every step has ended, not all with 0.
};

constexpr auto enum_words(task_state) {
  return std::array<std::string_view, 6>{"deploying",   "running",  "degraded",
                                         "terminating", "finished", "failed"};
}

/// What is known of one task.
struct task_row {
  std::string task;
  task_state state = task_state::deploying;
  int64_t submitted_unix_ms = 0;
  int64_t ended_unix_ms = 0; ///< Of a finished or failed one; 0: it goes on.
  std::vector<instance_row> instances;
  int64_t run = 1; ///< How often it has been started as a whole.
  /// When what still runs of it is ended; 0: it has no `timeout_s`, or has
  /// ended.
  int64_t deadline_unix_ms = 0;
  int64_t revision = 1; ///< Of its request; each update makes the next one.
  /// How far its update is, one sentence; empty: it is not being updated.
  std::string updating;
  /// Why the last update was put back; empty: it was not.
  std::string update_problem;
  std::map<std::string, std::string> labels; ///< As in `task_request`.
  std::string set;                           ///< The same.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_row::task),
        required("state", &task_row::state),
        required("submitted_unix_ms", &task_row::submitted_unix_ms),
        optional("ended_unix_ms", &task_row::ended_unix_ms),
        required("instances", &task_row::instances),
        optional("run", &task_row::run),
        optional("deadline_unix_ms", &task_row::deadline_unix_ms),
        optional("revision", &task_row::revision),
        optional("updating", &task_row::updating),
        optional("update_problem", &task_row::update_problem),
        optional("labels", &task_row::labels),
        optional("set", &task_row::set)};
  }
};

/// A node whose task of a set does not run as it is to.
struct set_problem {
  std::string node;
  std::string reason;

  static constexpr auto fields() {
    return field_list{required("node", &set_problem::node),
                      required("reason", &set_problem::reason)};
  }
};

/// What is known of a set of tasks.
struct task_set_row {
  std::string task; ///< Name of the set.
  int64_t submitted_unix_ms = 0;
  std::map<std::string, std::string> labels; ///< Of the nodes that it is for.
  int64_t nodes = 0;                         ///< How many these are at present.
  int64_t running = 0; ///< On how many of them its task runs as it is to.
  int64_t pending = 0; ///< On how many something is still to be done.
  std::vector<set_problem> problems;
  /// Nodes on which somebody has stopped its task: it stays so until the set is
  /// applied once more.
  std::vector<std::string> stopped;
  std::string request; ///< JSON of the `task_set_request`, where it is named.

  static constexpr auto fields() {
    return field_list{
        required("task", &task_set_row::task),
        required("submitted_unix_ms", &task_set_row::submitted_unix_ms),
        optional("labels", &task_set_row::labels),
        required("nodes", &task_set_row::nodes),
        required("running", &task_set_row::running),
        optional("pending", &task_set_row::pending),
        optional("problems", &task_set_row::problems),
        optional("stopped", &task_set_row::stopped),
        raw_json("request", &task_set_row::request)};
  }
};

/// Asks what has happened to a task, also to one that is gone.
struct task_history_query {
  static constexpr const char* type = "task_history_query";
  std::string task;

  static constexpr auto fields() {
    return field_list{required("task", &task_history_query::task)};
  }
};

/// What has happened to a task, in order: the first and the newest events, of
/// all nodes, across restarts of the coordinator.
struct task_history {
  static constexpr const char* type = "task_history";
  std::string task;
  std::vector<event> events;
  int64_t dropped = 0; ///< Events between the first and the newest ones.

  static constexpr auto fields() {
    return field_list{required("task", &task_history::task),
                      required("events", &task_history::events),
                      optional("dropped", &task_history::dropped)};
  }
};

struct task_query {
  static constexpr const char* type = "task_query";
  std::string task; ///< Or a set, for all its tasks; empty: all.

  static constexpr auto fields() {
    return field_list{optional("task", &task_query::task)};
  }
};

struct task_description {
  static constexpr const char* type = "task_description";
  std::vector<task_row> tasks;
  std::vector<task_set_row> sets;

  static constexpr auto fields() {
    return field_list{required("tasks", &task_description::tasks),
                      optional("sets", &task_description::sets)};
  }
};

/// Asks for the state of a task once it is another one than the asker knows.
/// The answer waits up to `wait_ms` for that, which is how a task is watched
/// without polling.
struct task_change_query {
  static constexpr const char* type = "task_change_query";
  std::string task;
  std::string known;   ///< The mark of the last answer; empty: nothing.
  int64_t wait_ms = 0; ///< At most 20,000.

  static constexpr auto fields() {
    return field_list{required("task", &task_change_query::task),
                      optional("known", &task_change_query::known),
                      optional("wait_ms", &task_change_query::wait_ms)};
  }
};

struct task_change {
  static constexpr const char* type = "task_change";
  std::string mark;               ///< Of this state; opaque.
  std::vector<task_row> tasks;    ///< The task; empty: the cell has none such.
  std::vector<task_set_row> sets; ///< The set, where it is one.

  static constexpr auto fields() {
    return field_list{required("mark", &task_change::mark),
                      required("tasks", &task_change::tasks),
                      optional("sets", &task_change::sets)};
  }
};

} // namespace roscell
