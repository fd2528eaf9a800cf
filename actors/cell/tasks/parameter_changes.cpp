#include "actors/cell/tasks/parameter_changes.hpp"

#include "messages/failure.hpp"

namespace roscell {

caf::result<parameters_changed> change_parameters(coordinator_pointer,
                                                  const parameter_change&) {
  return fail(error_code::conflict, "parameters cannot be changed yet");
}

} // namespace roscell
