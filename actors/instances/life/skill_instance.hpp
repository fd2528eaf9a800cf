#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "actors/edge/process/parameter_file.hpp"
#include "actors/edge/process/skill_grants.hpp"
#include "actors/instances/life/health_table.hpp"
#include "actors/instances/skills/current_skills.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

struct skill_instance_config {
  actor_context context;
  container_supervisor_actor supervisor; ///< Told of every change.
  runtime_actor runtime;
  state_store_actor store;
  shared_skills skills;
  /// Its skill as it was when the instance was deployed; null: not known.
  shared_skill_folder skill;
  instance_row row;          ///< What is known of the instance.
  bool adopt = false;        ///< It may run already.
  bool builds_images = true; ///< The runtime needs an image of the skill.
  graph_watch_actor graph;   ///< Sees ROS 2 programs; may be invalid in tests.
  /// What this node says of the cell; it counts more than what the spec says.
  std::map<std::string, std::string> environment;
  /// Whether `environment` is what it says now: until then nothing is started.
  bool knows_place = true;
  /// This node may be lost by its cell: what may move to another one then ends
  /// here before.
  bool may_be_lost = false;
  bool confirmed = false; ///< The coordinator in contact wants it to go on.
  /// The last word that has reached the coordinator; 0: none has.
  int64_t contact_boot_ms = 0;
  std::string address; ///< The node's, at which programs are started.
  /// Of one that is adopted: where the node was then; empty: not known.
  std::string started_at;
  std::string boot;       ///< The present one of the host; empty: not known.
  std::string started_in; ///< The one in which an adopted one was started.
  /// Why one that is adopted is to be started again, unless its program goes on
  /// when it is told; empty: it goes on.
  std::string renewal;
  environment_writer write_environment_update; ///< Empty: it cannot be told.
  parameter_writer write_parameters;           ///< The same.
  shared_skill_grants grants;  ///< Null: nothing is granted to any skill.
  std::string node;            ///< Its name, for what it says.
  secret_keeper_actor secrets; ///< Invalid: this node keeps none.
};

/// A change of parameters that its program has been told, and who waits for it.
struct awaited_parameters {
  int64_t number = 0;
  std::string parameters; ///< All that there are to be.
  std::chrono::steady_clock::time_point until;
  caf::typed_response_promise<parameters_set> promise;
};

/// Owns one instance from intent to end. The diagram is in docs/protocols.md.
struct skill_instance_state {
  static constexpr const char* name = "skill-instance";

  skill_instance_config config;
  instance_row row;
  bool begun = false;

  /// Raised at every turn; answers and ticks of an older one are ignored.
  uint64_t phase = 0;

  /// READY=1 came before the runtime's answer.
  bool ready = false;

  /// Its deadline has passed, and the last words are being heard.
  bool listening = false;

  /// The deadline was noticed late: this process, or the whole host, was
  /// stopped, and maybe the program, too.
  bool was_away = false;

  /// It has been given time for that since its last word.
  bool excused = false;

  /// It is started as soon as it is known where its cell is.
  bool awaits_place = false;

  /// It has ended, and only the end of its log is waited for.
  bool concluding = false;

  /// Its record says that it runs, maybe in the container of an earlier run:
  /// the runtime finds the present one.
  bool noted_running = false;
  alarm::time_point noted_at; ///< When that was written down.

  /// It has been ready since it was deployed, so it is started again when it
  /// ends, and a failure is no failure of its deployment.
  bool has_run = false;

  /// When it was ready last, on this clock.
  std::optional<alarm::time_point> ready_since;

  /// What the streams of this run say; none before its skill has told of them.
  std::optional<health_table> health;

  /// Whether the node's discovery server knows this run; none: nobody looks.
  std::optional<server_sight> sight;

  /// Why it is to end for good; it is not started again.
  std::optional<std::string> farewell;

  std::string started_at; ///< Where the node was when this run began.
  std::string started_in; ///< The boot of the host in which it did.

  /// It is started again when it ends, whatever its policy says: that is why
  /// it is to end.
  bool renewing = false;

  /// When its program was told that its cell is elsewhere.
  std::optional<alarm::time_point> ordered_at;

  /// When one that is to end, and is not stop-safe yet, ends all the same.
  std::optional<alarm::time_point> patience;

  /// The coordinator has been out of reach, and not told yet what it wants.
  bool out_of_contact = false;

  /// When its container ends unless the node hears of its cell; 0: never.
  int64_t fence_boot_ms = 0;

  /// Of a stock ROS 2 program, which neither says that it is ready nor that it
  /// is alive: its endpoints say both. None: it speaks for itself.
  std::optional<watch_endpoints> endpoints;
  std::vector<std::string> missing; ///< Of these, as they were told last.

  /// Number of the change that its program was told last; 0: none by this
  /// process of the node.
  int64_t last_change = 0;
  std::optional<awaited_parameters> change; ///< That is not answered.

  /// Its program is known to work with what its spec says. Not so of one that
  /// an earlier run of the node has told something, maybe.
  bool works_with_spec = true;

  /// Number of the change by which it was last put back to that; 0: none.
  int64_t correction = 0;

  /// Its program is to be given what its spec says once it is known to run.
  bool passes_on_when_ready = false;

  /// Whether its program runs at all is not known yet.
  bool adopting = false;

  std::optional<alarm::time_point> deadline;
  alarm timer;
};

/// The SKILL INSTANCE. Messages: messages/inside/runtime.hpp.
skill_instance_actor::behavior_type skill_instance(
    skill_instance_actor::stateful_pointer<skill_instance_state> self,
    const skill_instance_config& config);

} // namespace roscell
