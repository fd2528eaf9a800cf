#pragma once

#include "messages/coordination.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A moment on two clocks: one for decisions, one for people to read.
struct registry_time {
  std::chrono::steady_clock::time_point steady;
  int64_t unix_ms = 0;
};

/// What the registry keeps of one node besides its row.
struct registry_entry {
  registry_row row;
  std::vector<installed_skill> skills;
  std::vector<skill_problem> refused_skills;
  node_agent_actor agent; ///< Invalid unless the row is active.
  member_actor member;    ///< Invalid for the coordinator's own node.
  std::chrono::steady_clock::time_point inactive_since;
  join_origin origin = join_origin::given;
  std::chrono::steady_clock::time_point held_until; ///< Reserved rows.
  std::string transfer;                             ///< Of departing rows.
};

/// What of a row outlives the coordinator's process.
struct member_record {
  node_identity identity;
  join_origin origin = join_origin::given;

  static constexpr auto fields() {
    return std::make_tuple(required("identity", &member_record::identity),
                           required("origin", &member_record::origin));
  }
};

/// What other coordinators are told of a row.
member_claim claim_of(const registry_row& row);

/// The coordinator's table of nodes. Pure: it decides nothing about tasks and
/// sends nothing.
class cell_registry {
public:
  /// Why a node cannot have a row now, if so: its name belongs to another
  /// UUID, or its epoch is older than one already seen.
  std::optional<std::string> refusal(const node_identity& who,
                                     const registry_time& now) const;

  /// Keeps a place for a node until then; one that has a row keeps that.
  registry_entry& reserve(const node_identity& who,
                          std::chrono::steady_clock::time_point until,
                          const registry_time& now);

  /// Drops the places whose time is over, and gives their UUIDs.
  std::vector<std::string>
  drop_overdue(std::chrono::steady_clock::time_point now);

  /// When the next place is overdue; time_point::max() if none is kept.
  std::chrono::steady_clock::time_point next_overdue() const;

  /// A row for a node that an earlier run of the coordinator had.
  void expect(const member_record& known, const registry_time& now);

  /// The row of a node that is about to leave. Nothing new is placed on it.
  void depart(registry_entry& entry, std::string transfer,
              const registry_time& now);

  /// Takes `depart` back.
  void stay(registry_entry& entry, const registry_time& now);

  /// Makes the node's row active, replacing what was known of it.
  registry_entry& activate(registry_entry entry, const registry_time& now);

  /// Null unless the present member of that row is `member`.
  registry_entry* find_member(const std::string& uuid,
                              const member_actor& member);

  registry_entry* find_uuid(const std::string& uuid);
  registry_entry* find_name(const std::string& name);
  const registry_entry* find_name(const std::string& name) const;

  /// Changes the state of a row that is no longer active.
  void deactivate(registry_entry& entry, row_state state, std::string reason,
                  const registry_time& now);
  void erase(const std::string& uuid);

  /// Brings one instance's row up to date.
  void update_instance(const instance_row& instance);
  void erase_instance(const std::string& instance);

  /// The row of an instance, wherever it is; null if unknown.
  const instance_row* find_instance(const std::string& instance) const;

  /// Rows in the order of the nodes' names.
  std::vector<registry_row> rows() const;
  size_t active_count() const;

  /// Rows that count when places are given out: active, reserved, departing.
  size_t size() const;

  /// What other coordinators are told of the rows.
  std::vector<member_claim> claims() const;

  /// Builds of the active nodes, the same content together.
  std::vector<skill_row> skills(const std::string& operation) const;

  /// What active nodes have refused to take for skills, by node.
  std::vector<refused_skill> refused_skills() const;

  void for_each(const std::function<void(registry_entry&)>& visit);
  void for_each_active(const std::function<void(registry_entry&)>& visit);

private:
  std::map<std::string, registry_entry> by_uuid_;
};

} // namespace roscell
