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
  node_agent_actor agent; ///< Invalid unless the row is active.
  member_actor member;    ///< Invalid for the coordinator's own node.
  std::chrono::steady_clock::time_point inactive_since;
};

/// The coordinator's table of nodes. Pure: it decides nothing about tasks and
/// sends nothing.
class cell_registry {
public:
  /// How long a lost node keeps its name for itself: one lease.
  static constexpr std::chrono::seconds name_held{8};

  /// Why a node cannot have a row now, if so: its name belongs to another
  /// UUID, or its epoch is older than one already seen.
  std::optional<std::string> refusal(const node_identity& who,
                                     const registry_time& now) const;

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

  /// Skills of the active nodes, the same content together.
  std::vector<skill_row> skills(const std::string& operation) const;

  void for_each_active(const std::function<void(registry_entry&)>& visit);

private:
  std::map<std::string, registry_entry> by_uuid_;
};

} // namespace roscell
