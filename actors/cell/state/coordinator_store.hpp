#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>

/// How the CELL COORDINATOR writes its records down.
namespace roscell {

/// Writes a record, or removes it if its value is empty, and calls one of the
/// two: `kept` when it is on disk, `not_kept` with why it is not. Without a
/// store everything is kept at once.
void keep_record(coordinator_pointer self, const store_record& record,
                 std::function<void()> kept,
                 std::function<void(const failure&)> not_kept);

/// The same for what has happened already and cannot be refused any more. A
/// store that fails is told of.
void record_fact(coordinator_pointer self, const store_record& record);

} // namespace roscell
