#pragma once

#include "messages/inside/link.hpp"

#include <map>
#include <set>
#include <string>

namespace roscell {

/// The coordinators that a node without a cell sees, and which of them it asks
/// for a place. Pure. Anybody may announce a coordinator, so they are few, and
/// those that did not answer make room for others.
class coordinators_seen {
public:
  /// Whether that is news: what is repeated is none, and what there is no room
  /// for is not heard.
  bool see(const node_presence& who);

  void vanish(const std::string& uuid);
  void clear();

  /// It did not answer: the others are asked first.
  void mark_unresponsive(const std::string& uuid);

  /// All are worth a try again.
  void forgive();

  /// The one that hands out places: the lowest UUID, as every node computes it,
  /// of those that are not silent. Null if there is none.
  const node_presence* slot_arbiter() const;

  size_t size() const {
    return by_uuid_.size();
  }

private:
  std::map<std::string, node_presence> by_uuid_;
  std::set<std::string> silent_;
};

} // namespace roscell
