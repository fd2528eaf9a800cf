#include "actors/cell/sets/cell_sets.hpp"

#include "messages/failure.hpp"

namespace roscell {

caf::result<task_set_plan> apply_set(coordinator_pointer,
                                     const task_set_request&) {
  return fail(error_code::conflict, "sets are not there yet");
}

} // namespace roscell
