#pragma once

#include "actors/alarm.hpp"
#include "actors/backoff.hpp"
#include "actors/house.hpp"
#include "actors/lease.hpp"
#include "actors/session_exchange.hpp"
#include "messages/type_ids.hpp"

#include <caf/typed_response_promise.hpp>

#include <array>
#include <chrono>
#include <map>
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
  resource_probe_actor probe; ///< Gets a mark with every beat; may be invalid.
};

/// What a membership is told at its start.
struct membership_config {
  node_identity identity; ///< With the epoch that was stored last.
  std::vector<installed_skill> skills;
};

/// What the membership is doing; `node_state` is what others see of it. The
/// diagram is in docs/protocols.md.
enum class membership_phase {
  resting,     ///< No cell is wanted.
  waiting,     ///< Until the next attempt.
  searching,   ///< For the discovery server.
  opening,     ///< Storing the new epoch, then opening a session.
  registering, ///< The session is there.
  joined,
  leaving, ///< Still joined; the coordinator is being told.
};

constexpr auto enum_words(membership_phase) {
  return std::array<std::string_view, 7>{"resting", "waiting",     "searching",
                                         "opening", "registering", "joined",
                                         "leaving"};
}

/// Owns the node's belonging to a cell.
struct membership_status {
  static constexpr const char* name = "membership";

  using time_point = std::chrono::steady_clock::time_point;

  house context;
  membership_parts parts;
  membership_config config;

  node_state standing = node_state::independent;
  membership_phase phase = membership_phase::resting;
  std::string wanted; ///< Discovery server; empty: none.

  /// The cell that the node is in, or was when it was orphaned.
  std::string cell;
  std::string coordinator; ///< Its name.
  std::string address;     ///< Of its HTTP port.
  int64_t incarnation = 0;
  time_point joined_at;

  /// Counts attempts, so that answers to an earlier one can be told.
  uint64_t attempt = 0;
  time_point deadline; ///< Of `waiting` and `searching`.
  backoff pause;
  std::string trouble; ///< Why the last attempt failed.
  std::string refusal; ///< The last one that was told as an event.

  /// What an attempt has gathered so far.
  std::optional<coordinator_found> older; ///< Found, with an old incarnation.
  std::string found_address;
  std::optional<session_opened> opened;
  std::optional<node_resources> resources;
  std::optional<std::vector<instance_row>> instances;
  bool registration_sent = false;
  /// Changes since `instances` were asked for, by instance.
  std::map<std::string, instance_changed> unsent;

  session_actor session; ///< Valid from `registering` to `leaving`.
  lease life;
  session_exchange frames;
  alarm timer;

  std::vector<caf::typed_response_promise<node_departed>> leavers;
};

/// The MEMBERSHIP. Messages: messages/membership.hpp. Events: cell_joined,
/// cell_left, coordinator_lost, join_refused, each about this node. It stores
/// its identity in table "identity" under the key "node" before every
/// registration, with the epoch raised.
membership_actor::behavior_type
membership(membership_actor::stateful_pointer<membership_status> self,
           house context, membership_parts parts, membership_config config);

} // namespace roscell
