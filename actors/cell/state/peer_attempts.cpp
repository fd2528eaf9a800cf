#include "actors/cell/state/peer_attempts.hpp"

#include <algorithm>

namespace roscell {

namespace {

using time_point = std::chrono::steady_clock::time_point;

/// Of two coordinators the one with the higher UUID opens the session.
bool opens_here(const cell_coordinator_state& st, const std::string& uuid) {
  return uuid < st.setup.self.uuid;
}

} // namespace

bool is_coordinator(const node_presence& who) {
  return who.role == "coordinator";
}

bool is_due(const cell_coordinator_state& st, const node_presence& who,
            time_point now) {
  if (!is_coordinator(who) || !opens_here(st, who.uuid))
    return false;
  const auto peer = st.peers.find(who.uuid);
  if (peer != st.peers.end() && peer->second.actor)
    return false;
  const auto i = st.attempts.find(who.uuid);
  return i == st.attempts.end()
         || (!i->second.running && i->second.next <= now);
}

time_point next_peer_attempt(const cell_coordinator_state& st) {
  auto result = time_point::max();
  for (const auto& [uuid, attempt] : st.attempts) {
    const auto who = st.presences.find(uuid);
    if (who != st.presences.end() && is_due(st, who->second, time_point::max()))
      result = std::min(result, attempt.next);
  }
  return result;
}

} // namespace roscell
