#pragma once

#include "actors/cell/tables/unauthenticated_calls.hpp"
#include "messages/cell.hpp"
#include "messages/inside/link.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// The nodes in no cell that announce themselves. What they announce is a hint:
/// where a row of the registry hangs on it, they are asked to prove it first.
/// Pure: it asks nobody, and is told the time.
class unassigned_node_table {
public:
  using time_point = std::chrono::steady_clock::time_point;
  using doubt = std::function<bool(const node_presence&)>;

  enum class sighting { appeared, changed, repeated, ignored };

  unassigned_node_table();

  sighting see(const node_presence& who, time_point now);

  /// It announces itself no more. False if that was not known, or if a later
  /// life of it is known. Its row stays for a while, and says since when.
  bool vanish(const node_presence& who, int64_t now_unix_ms);

  /// Nobody answers at its address.
  void forget(const std::string& uuid);

  /// It has registered: what it had announced before that is out of date.
  void registered(const node_identity& who);

  /// Null if it has announced nothing.
  const node_presence* find(const std::string& uuid) const;

  /// Of several that claim the name the one with the highest epoch.
  const node_presence* find_name(const std::string& name) const;

  /// Those that announce themselves, then those that do so no more.
  std::vector<unassigned_node> rows() const;

  size_t size() const {
    return by_uuid_.size();
  }

  // -- proofs -----------------------------------------------------------------

  /// Takes those that are to be asked for a proof now; each has to end in one
  /// of the next two. `is_wanted` says on whose word something hangs.
  std::vector<node_presence> begin_questions(const doubt& is_wanted,
                                             time_point now);

  void question_failed(const std::string& uuid, const std::string& reason,
                       time_point now);

  /// False if nobody wants to know any more.
  bool question_answered(const std::string& uuid);

  /// When `begin_questions` has something next.
  time_point next_question(const doubt& is_wanted) const;

private:
  void remember_silent(const node_presence& who, int64_t now_unix_ms);

  std::map<std::string, node_presence> by_uuid_;
  std::map<std::string, unassigned_node> silent_; ///< By UUID.
  unauthenticated_calls calls_;
};

} // namespace roscell
