#pragma once

#include "actors/cell/cell_coordinator.hpp"
#include "actors/requests/request_router.hpp"
#include "test/fixture.hpp"

#include <caf/response_promise.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// A coordination node in miniature: the real router, pipelines, scheduler and
/// cell coordinator, among fake nodes and a fake disk, on virtual time.
namespace roscell::test {

using namespace std::chrono_literals;

/// How a fake node answers a deployment.
enum class temper { happy, broken, slow };

/// A node: what it has, what runs on it, and what was asked of it.
struct fake_agent {
  node_identity identity;
  node_resources has; ///< `used` leaves instances out.
  temper mood = temper::happy;
  std::vector<installed_skill> skills; ///< `echo_skill()` unless changed.
  bool silent = false;                 ///< Answers nothing about resources.
  bool mute = false;                   ///< Answers nothing about metrics.
  std::vector<kept_log> logs_kept;
  bool slow_reports = false;  ///< Measures at once, answers when told to.
  bool slow_removals = false; ///< Removes when told to.

  caf::actor actor;
  member_actor member; ///< The same actor, as its row has it.
  cell_coordinator_actor coordinator;

  std::map<std::string, instance_row> running;
  std::set<std::string> not_stop_safe; ///< Instances that do not end yet.
  std::vector<instance_reservation> reservations;
  bool reports_reserved = false; ///< Its reports count what it has reserved.
  int reluctance = 0; ///< How many reservations it refuses from now on.
  std::vector<instance_spec> deployments;
  std::vector<build_offer> fetches; ///< Of each deployment.
  bool fetches_builds = true;       ///< It says so when it registers.
  bool gets_nothing = false;        ///< No build comes to it.
  std::vector<build_keeping> keepings;
  std::function<void()> on_keeping;          ///< Called before it answers one.
  std::map<std::string, std::string> images; ///< Ids by name.
  std::vector<image_sharing> sharings;
  build_name shared_build;
  std::vector<std::string> releases; ///< Hashes.
  std::vector<instance_removal> removals;
  std::vector<set_parameters> changes;     ///< Of parameters, as it was told.
  bool slow_changes = false;               ///< Answers these when told to.
  std::vector<registration_switch> orders; ///< To go elsewhere.
  std::vector<std::string> closed;         ///< Reasons of `close_session`.
  std::vector<std::string> kept; ///< Instances of the coordination node.
  caf::actor deployer;           ///< The pipeline that asked last.

  std::vector<std::pair<caf::response_promise, instance_spec>> starting;
  std::vector<std::pair<caf::response_promise, resource_report>> reports;
  std::vector<std::pair<caf::response_promise, instance_removal>> ending;
  std::vector<std::pair<caf::response_promise, std::string>> changing;
  std::vector<caf::response_promise> unanswered;
  std::vector<std::function<void()>> todo; ///< For the actor itself.

  /// Tells the coordinator of an instance, as this node.
  void report_row(const instance_row& row);

  void bring_up(caf::response_promise promise, const instance_spec& spec);
  void take_down(caf::response_promise promise, const instance_removal& what);

  /// An instance that was to end is stop-safe, and ends.
  void become_stop_safe(const std::string& instance);

  /// End what has been kept waiting, once messages are handled: a promise can
  /// only be kept by its actor.
  void finish_starting();
  void finish_changes(const std::optional<failure>& refusal = std::nullopt);
  void fail_starting(const std::string& reason);
  void report_metrics(); ///< Of what it was asked while it was mute.
  void finish_reports();
  void finish_removals();
  void fail_removals(); ///< As of a member that is lost.
};

/// An event that somebody has told.
struct cell_event {
  std::string what;
  std::string subject;
  json data;
};

using pending_reply =
    std::shared_ptr<std::optional<caf::expected<request_routed>>>;

/// To be kept at one place: the actors point to it.
struct paper_cell {
  virtual_time time;
  std::map<std::string, json> disk;    ///< Records of the table "tasks".
  std::map<std::string, json> history; ///< The same of that table,
  std::map<std::string, json> drains;  ///< of that one,
  std::map<std::string, json> members; ///< of that one,
  std::map<std::string, json> builds;  ///< of that one,
  std::map<std::string, json> sets;    ///< of "task_sets",
  std::map<std::string, json> remains; ///< and of "removed_builds".
  /// What the coordination node's keeper says that builds are, by hash.
  std::map<std::string, installed_skill> kept_builds;
  std::vector<std::string> dropped_builds; ///< What it was told to drop.
  bool ros2_set_parameters = false; ///< Of a coordinator that begins anew.
  /// The same: "ada" has signed what says so.
  bool require_signed_skills = false;
  bool disk_full = false;
  bool slow_disk = false; ///< Writes when told to.
  std::vector<std::pair<caf::response_promise, store_records>> writes;
  std::vector<cell_event> events;
  std::vector<std::unique_ptr<fake_agent>> agents;
  caf::actor event_collector;
  caf::actor store;
  caf::actor build_store;
  actor_context context;
  std::shared_ptr<search_guard> searches;
  scheduler_actor planner;
  cell_coordinator_actor coordinator;
  request_router_actor router;
  fake_agent& base;

  /// `base` is the coordination node; it can run the skill `echo`.
  explicit paper_cell(const std::vector<task_record>& tasks = {},
                      const std::vector<instance_row>& on_base = {});
  ~paper_cell();

  paper_cell(const paper_cell&) = delete;
  paper_cell& operator=(const paper_cell&) = delete;

  /// A node of 4 cores, 1000 MiB of memory and 1000 MiB of disk.
  fake_agent& make_agent(const std::string& name);

  /// The same, and it registers.
  fake_agent& add(const std::string& name);
  caf::expected<node_registered> enter(fake_agent& x);
  void lose(fake_agent& x);
  void depart(fake_agent& x);

  /// What the router replies to a document, at once or later.
  json request(const json& document);
  json request_text(const std::string& text);
  pending_reply post(const json& document);

  /// The coordinator is killed, and begins anew with what is on the disk.
  void begin_anew();

  void write(const store_record& x);
  void finish_writes();

  registry_row row(const std::string& node);
  json tasks();
  size_t count(const std::string& event) const;

private:
  void start_parts(const coordinator_setup& how);
  coordinator_setup setup(const std::vector<task_record>& tasks,
                          const std::vector<instance_row>& on_base);
};

json reply_of(const pending_reply& x);
std::string error_of(const json& reply);

/// Without how the request has found its task, and what had gone before.
json placement_in(json accepted);

installed_skill echo_skill();

/// The same as "grasp", which says when it may be ended.
installed_skill grasp_skill();

/// A step that takes 1 to 4 cores, on any node or on the one named.
json echo_step(const std::string& id, int cores, const std::string& node = "");
json echo_task(const std::string& task, const std::vector<json>& steps);

json termination(const std::string& task, bool force = false);

instance_spec echo_instance(const std::string& instance,
                            const std::string& task = "t",
                            const std::string& step = "s0");

instance_row row_of(const instance_spec& spec, const std::string& node,
                    instance_state state = instance_state::running);

/// The record of the task of these instances, each on its node.
task_record kept_record(const std::vector<instance_spec>& specs,
                        const std::vector<std::string>& nodes,
                        task_state state = task_state::running);

} // namespace roscell::test
