#pragma once

#include "actors/cell/tables/unauthenticated_calls.hpp"
#include "messages/inside/coordination.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// Another coordinator, as far as its session has told.
struct peer_entry {
  peer_actor actor;      ///< Invalid while there is no session.
  bool reported = false; ///< Its status has come.
  cell_standing status;
  std::map<std::string, member_claim> members; ///< By UUID.
};

/// The other coordinators: what is announced of them, which is a hint, and what
/// those have said that proved themselves by a session. Pure: it opens nothing
/// and is told the time.
class peer_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// What an announcement was worth.
  enum class sighting {
    appeared, ///< Nobody had announced this coordinator.
    changed,
    repeated,
    ignored, ///< It is our own, or there are too many unauthenticated peers.
  };

  /// @param self UUID of the own coordinator.
  explicit peer_table(std::string self = {});

  // -- what is announced ------------------------------------------------------

  sighting see(const node_presence& who, time_point now);

  /// It announces itself no more. False if that was not known, or if a later
  /// life of it is known.
  bool vanish(const node_presence& who);

  bool is_announced(const std::string& node_name) const;

  /// Whether a coordinator has appeared a moment ago that has not told its
  /// status yet, and has not failed to.
  bool expects_statuses(time_point now) const;

  // -- sessions that are to be opened -----------------------------------------

  /// Takes those whose turn it is; each has to end in one of the next two.
  std::vector<node_presence> begin_due(time_point now);

  /// The cell of the coordinator if this is the first failure for that reason.
  std::optional<std::string> attempt_failed(const std::string& uuid,
                                            const std::string& reason,
                                            time_point now);

  /// False if nobody wants that session any more.
  bool attempt_succeeded(const std::string& uuid);

  /// When `begin_due` has something next; max() if nothing is known.
  time_point next_due() const;

  // -- sessions that are there ------------------------------------------------

  /// A newer session replaces the former one, whose actor is given back.
  peer_actor open(const std::string& uuid, const peer_actor& peer);

  /// What was known, if that was its present session.
  std::optional<peer_entry> close(const std::string& uuid,
                                  const peer_actor& peer,
                                  const std::string& reason, time_point now);

  /// Null if that is no present session.
  peer_entry* note_status(const peer_actor& peer, const cell_standing& status);

  /// The same. What has changed is entered if the status has come before.
  peer_entry* note_status(const peer_actor& peer, const cell_changed& change);

  /// Null unless that is a present session.
  const peer_entry* find_session(const peer_actor& peer) const;

  /// The one whose present session that is; empty if none.
  std::string find_uuid(const caf::actor_addr& peer) const;

  /// Null unless it has a session.
  peer_entry* find(const std::string& uuid);
  const peer_entry* find(const std::string& uuid) const;

  /// The one of that cell; null unless it has told its status.
  const peer_entry* find_cell(const std::string& cell) const;

  /// The one that has the newest row for the node; null if none has.
  const peer_entry* find_holder(const std::string& node) const;

  /// The lowest UUID first.
  void for_each_session(
      const std::function<void(const std::string&, const peer_entry&)>& visit)
      const;

  /// Ids of the discovery servers of other cells, as far as they are known.
  std::set<int64_t> server_ids() const;

  /// A row for each coordinator that is known, without the own one.
  /// @param own the row of the own cell, whose name another may claim too.
  std::vector<cell_row> rows(const cell_row& own) const;

  size_t unauthenticated_peers() const;

private:
  struct known {
    std::optional<node_presence> announced;
    time_point appeared; ///< When it was announced first, or anew.
    bool proved = false; ///< It has had a session.
    peer_entry session;
  };

  bool opens_here(const std::string& uuid) const;
  bool is_wanted(const std::string& uuid, const known& x) const;
  bool make_room();
  void drop_if_gone(const std::string& uuid);
  peer_entry* find_session(const peer_actor& peer);

  std::string self_;
  std::map<std::string, known> by_uuid_;
  unauthenticated_calls calls_;
};

} // namespace roscell
