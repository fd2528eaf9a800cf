#include "actors/instances/life/skill_instance_steps.hpp"
#include "messages/failure.hpp"

namespace roscell {

caf::result<parameters_set> take_parameters(skill_instance_pointer,
                                            const set_parameters&) {
  return fail(error_code::conflict, "parameters cannot be changed yet");
}

} // namespace roscell
