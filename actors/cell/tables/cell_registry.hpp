#pragma once

#include "messages/failure.hpp"
#include "messages/inside/coordination.hpp"
#include "messages/inside/storage.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <set>
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
  int64_t server_id = -1; ///< Of its discovery server; negative: none.
  std::chrono::steady_clock::time_point held_until; ///< Reserved rows.
  bool fetches_builds = false; ///< It can get skills from other nodes.
  std::string build_key;       ///< What permits for its builds are signed with.
};

/// What of a row outlives the coordinator's process.
struct member_record {
  node_identity identity;
  join_origin origin = join_origin::given;
  int64_t server_id = -1; ///< Of its discovery server; negative: none.

  static constexpr auto fields() {
    return field_list{required("identity", &member_record::identity),
                      required("origin", &member_record::origin),
                      optional("server_id", &member_record::server_id)};
  }
};

/// What other coordinators are told of a row.
member_claim claim_of(const registry_row& row);

/// The coordinator's table of nodes. Pure: it decides nothing about tasks and
/// sends nothing. What of it is durable is proposed first, and entered once it
/// has been written down.
class cell_registry {
public:
  /// Why a node cannot have a row now, if so: its UUID is in use at another
  /// address, its name belongs to another UUID, its epoch is older than one
  /// already seen, or there are too many rows. A member that is known to be
  /// `gone` uses nothing any more.
  std::optional<failure> refusal(const node_identity& who,
                                 const registry_time& now,
                                 const member_actor& gone = {}) const;

  /// The member that has the UUID at another address, if it has not gone from
  /// there meanwhile. Invalid: there is none.
  member_actor rival_of(const node_identity& who) const;

  /// Whether there is a row for no further node.
  bool is_full() const;

  /// An id for the node's own discovery server that no other row has, nor the
  /// coordinator's, which is `own`, the lowest; one that is used `elsewhere`,
  /// by other coordinators in sight, only where there is no other. `last` is
  /// the one that it had: kept if this cell gave it, avoided if another did,
  /// whose programs may still look for it. Negative: none is left, as if there
  /// were more rows than `refusal` lets in.
  int64_t choose_server_id(const std::string& uuid, int64_t last,
                           bool last_is_ours, int64_t own,
                           const std::set<int64_t>& elsewhere) const;

  // -- a registration ---------------------------------------------------------

  /// Claims name and UUID for a row that is to be active, until one of the next
  /// two. The records have to be written all at once: the node's own, and no
  /// value for those that it displaces.
  std::vector<store_record> propose(registry_entry entry);

  /// The records are kept: makes the proposed row active. Null if another
  /// registration has come after it.
  registry_entry* accept(const std::string& uuid, const member_actor& member,
                         const registry_time& now);

  /// The registration comes to nothing.
  void withdraw(const std::string& uuid, const member_actor& member);

  /// Whether a row of this node is there or about to be.
  bool expects(const std::string& uuid) const;

  /// The same, of whatever a member that has ended had proposed.
  void withdraw(const caf::actor_addr& member);

  /// Whether nothing but the epoch would change on disk.
  bool is_known(const node_identity& who, join_origin origin,
                int64_t server_id) const;

  // -- rows -------------------------------------------------------------------

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
  void depart(registry_entry& entry, const registry_time& now);

  /// Takes `depart` back.
  void stay(registry_entry& entry, const registry_time& now);

  /// Makes the node's row active, replacing what was known of it and of those
  /// that had the name before.
  registry_entry& activate(registry_entry entry, const registry_time& now);

  /// Null unless the present member of that row is `member`.
  registry_entry* find_member(const std::string& uuid,
                              const member_actor& member);

  registry_entry* find_uuid(const std::string& uuid);
  const registry_entry* find_uuid(const std::string& uuid) const;

  /// The row that owns the name. Of several rows of one name an active one
  /// does, else the one that came first.
  registry_entry* find_name(const std::string& name);
  const registry_entry* find_name(const std::string& name) const;

  /// Changes the state of a row that is no longer active.
  void deactivate(registry_entry& entry, row_state state, std::string reason,
                  const registry_time& now);
  void erase(const std::string& uuid);

  /// Rows in the order of the nodes' names, without instances: what is deployed
  /// where stands in the deployment table.
  std::vector<registry_row> rows() const;
  size_t active_count() const;

  /// Rows that count when slots are granted: active, reserved, departing.
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
  bool gives_name_up(const registry_entry& x, const node_identity& to,
                     const registry_time& now) const;
  void settle_owner(const std::string& name);
  std::optional<failure> copy_refusal(const node_identity& who,
                                      const member_actor& gone) const;
  std::optional<failure> name_refusal(const node_identity& who,
                                      const registry_time& now) const;

  std::map<std::string, registry_entry> by_uuid_;
  std::map<std::string, std::string> owners_; ///< UUID by name.
  std::map<std::string, registry_entry> proposed_;
};

} // namespace roscell
