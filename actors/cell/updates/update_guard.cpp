#include "actors/cell/updates/update_guard.hpp"

namespace roscell {

std::optional<failure> why_updating(const cell_coordinator_state& st,
                                    const std::string& task) {
  if (!st.updates.is_updating(task))
    return std::nullopt;
  return failure{error_code::conflict,
                 "task '" + task
                     + "' is being updated: " + st.updates.text(task),
                 "/task", "send it again when that is done"};
}

void drop_update(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  const auto id = st.updates.find_id(task);
  st.updates.end(id);
  st.update_runs.erase(id);
}

} // namespace roscell
