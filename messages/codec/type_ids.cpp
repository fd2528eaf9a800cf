#include "messages/messages.hpp"

#include <caf/actor_system_config.hpp>
#include <caf/init_global_meta_objects.hpp>

namespace roscell {

void add_message_types(caf::actor_system_config& config) {
  config.add_message_types<caf::id_block::roscell>();
}

} // namespace roscell
