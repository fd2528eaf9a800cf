#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/core/backoff.hpp"
#include "actors/edge/disk/sqlite_store.hpp"
#include "messages/messages.hpp"

#include <map>
#include <memory>
#include <string>
#include <utility>

namespace roscell {

/// Owns the node's database. Spawned as one that blocks: it waits for the disk.
struct state_store_state {
  static constexpr const char* name = "state-store";

  actor_context context;
  std::shared_ptr<sqlite_store> database;
  /// What could not be written yet, by table and key; empty removes.
  std::map<std::pair<std::string, std::string>, std::string> waiting;
  backoff pause; ///< Until the next attempt.
  alarm timer;
  uint64_t written = 0; ///< Records stored or removed.
  uint64_t refused = 0; ///< Records that could not be.
};

/// The STATE STORE. Messages, and what each table holds:
/// messages/inside/storage.hpp.
state_store_actor::behavior_type
state_store(state_store_actor::stateful_pointer<state_store_state> self,
            const actor_context& context,
            std::shared_ptr<sqlite_store> database);

} // namespace roscell
