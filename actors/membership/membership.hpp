#pragma once

#include "actors/builds/build_permits.hpp"
#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/core/backoff.hpp"
#include "actors/edge/session/proofs.hpp"
#include "actors/edge/session/site_token.hpp"
#include "actors/membership/coordinators_seen.hpp"
#include "actors/membership/join_report.hpp"
#include "actors/session/held_session.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// Whom a membership works with on its node.
struct membership_parts {
  discovery_actor discovery;
  session_connector_actor connector;
  node_agent_actor agent; ///< Does what the coordinator asks for.
  container_supervisor_actor supervisor;
  state_store_actor store;
  join_diagnoser_actor diagnoser;
  build_keeper_actor keeper; ///< Invalid: the node gets no builds from others.
  std::shared_ptr<build_permits> permits; ///< The same; null.
};

/// What a membership is told at its start.
struct membership_config {
  node_identity identity; ///< With the epoch that was stored last.
  std::vector<installed_skill> skills;
  std::vector<skill_problem> refused_skills;
  /// As an earlier run has stored it. One of a cell is taken up at once.
  std::optional<membership_record> restored;
  std::string configured;    ///< How the node is started now; see the record.
  site_secret site;          ///< Proves switches.
  int64_t public_domain = 0; ///< In which the node sees others.
  /// Tells other hosts where this node's address is; empty: nothing tells.
  std::function<void()> claim_address{};
};

/// Whether the node goes on where an earlier run of it was: it is started in
/// the same way as then.
bool takes_up_earlier_cell(const membership_config& config);

/// What the membership is doing; `node_state` is what others see of it. The
/// diagram is in docs/protocols.md.
enum class membership_phase {
  resting,     ///< No cell is wanted.
  waiting,     ///< Until the next attempt.
  asking,      ///< A coordinator for a place.
  searching,   ///< For the discovery server.
  opening,     ///< Storing the new epoch, then opening a session.
  registering, ///< The session is there.
  joined,
  accepting, ///< A switch is being written down.
  leaving,   ///< Still joined; the coordinator is being told.
};

constexpr auto enum_words(membership_phase) {
  return std::array<std::string_view, 9>{
      "resting",     "waiting", "asking",    "searching", "opening",
      "registering", "joined",  "accepting", "leaving"};
}

/// A switch to another cell, and what the node goes back to if it fails.
struct switch_attempt {
  registration_switch order;
  node_state state = node_state::independent;
  /// `resting` or `joined`; any other was an attempt, which is over.
  membership_phase phase = membership_phase::resting;
  std::string wanted;
  join_origin origin = join_origin::given;
};

/// The node's own discovery server.
struct program_service {
  discovery_place place;
  std::string cell_uuid; ///< Of the cell that gave its id.
  std::string address;   ///< "ip:port"; empty: it does not run.
};

/// Owns the node's belonging to a cell. It holds a session while `asking`, and
/// from `registering` on.
struct membership_status : held_session {
  static constexpr const char* name = "membership";

  using time_point = std::chrono::steady_clock::time_point;

  actor_context context;
  membership_parts parts;
  membership_config config;

  node_state state = node_state::independent;
  membership_phase phase = membership_phase::resting;
  /// Discovery server, as "host:port"; empty: none.
  std::string wanted;
  join_origin origin = join_origin::given; ///< Why that one.
  bool seeking = false; ///< Wants a place wherever there is one.

  coordinators_seen coordinators;       ///< While the node announces itself.
  std::optional<node_presence> hurried; ///< For whom a pause was cut short.
  /// Where the cell of an orphan is now, as somebody announces without proof:
  /// tried in turn with where it was. Empty: nobody announces another place.
  std::string announced_place;
  bool owes_former = false; ///< The next attempt is where the cell was.
  std::string asked;        ///< The one that is asked for a slot.
  std::optional<node_presence> shown; ///< What the node announces.

  registration_challenges challenges;
  std::optional<switch_attempt> switching;
  std::string last_switch; ///< Its transfer.
  std::optional<membership_record> stored;

  /// The cell that the node is in, or was when it was orphaned.
  std::string cell;
  std::string cell_uuid;   ///< Empty: not known, then the name has to do.
  std::string coordinator; ///< Its name.
  std::string address;     ///< Of its HTTP port.
  int64_t incarnation = 0;
  /// When the present registration was sent, by the clock of the boot.
  int64_t registered_boot_ms = 0;
  time_point joined_at;
  std::optional<program_service> programs; ///< None: the cell gave no place.

  /// Counts attempts, so that answers to an earlier one can be told.
  uint64_t attempt = 0;
  time_point deadline; ///< Of `waiting` and `searching`.
  backoff pause;
  std::string problem; ///< Why the last attempt failed.

  join_report report; ///< How the attempts go, for people.
  /// When the wanted address is looked at; max(): never.
  time_point look_due = time_point::max();
  std::string server_address; ///< Of `wanted`, in numbers, once it is known.
  bool diagnosed = false;     ///< The present attempt has been explained.

  /// What an attempt has gathered so far.
  std::optional<coordinator_found> older; ///< Found, with an old incarnation.
  std::string found_address;
  std::optional<session_opened> opened;
  std::optional<node_resources> resources;
  std::optional<std::vector<instance_row>> instances;
  bool registration_sent = false;
  /// Changes since `instances` were asked for, by instance.
  std::map<std::string, instance_changed> unsent;
  bool skills_unsent = false; ///< They are others since the registration.
  bool skills_heard = false;  ///< The coordinator takes word of them.
  bool gives_builds = false;  ///< It passes builds and images on.

  request_router_actor router; ///< Of this node; invalid while it starts.
  alarm timer;

  std::vector<caf::typed_response_promise<node_departed>> leavers;
};

/// The MEMBERSHIP. Messages: messages/inside/membership.hpp. Events:
/// cell_joined, cell_left, coordinator_lost, join_refused, join_failed,
/// switch_accepted, switch_failed, each about this node. It stores its identity
/// in table "identity" under the key "node" before every registration and every
/// switch, with the epoch raised, and its `membership_record` under the key
/// "membership" when it changes.
membership_actor::behavior_type
membership(membership_actor::stateful_pointer<membership_status> self,
           actor_context context, membership_parts parts,
           membership_config config);

} // namespace roscell
