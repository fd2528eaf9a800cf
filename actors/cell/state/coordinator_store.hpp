#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <vector>

/// How the CELL COORDINATOR writes its records down.
namespace roscell {

/// Writes records, and removes those whose value is empty, all or none. Calls
/// one of the two: `kept` when they are on disk, `not_persisted` with the
/// reason and a remedy when they are not, which is told as an event too.
/// Without a store everything is kept at once.
void keep_records(coordinator_pointer self, std::vector<store_record> records,
                  std::function<void()> kept,
                  std::function<void(const failure&)> not_persisted);

/// Removes a new record that was refused: a write whose answer did not come in
/// time may still be carried out, and the store writes in order.
void forget_refused(coordinator_pointer self, std::string table,
                    std::string key);

/// Writes down what has happened already and cannot be refused any more: a full
/// disk is written when it has room. A store that fails otherwise is told of.
void persist_record(coordinator_pointer self, store_record record);

} // namespace roscell
