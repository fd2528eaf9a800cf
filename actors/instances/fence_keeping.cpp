#include "actors/instances/fence_keeping.hpp"

#include "actors/edge/process/fence_file.hpp"

#include <utility>

namespace roscell {

void keep_fence(const actor_context& context, const std::filesystem::path& file,
                const fence_container& request, bool& fails) {
  const auto why = move_fence(file, request.fence_boot_ms);
  const auto failed_before = std::exchange(fails, why.has_value());
  if (why && !failed_before)
    context.publish_event("fence_failed", request.instance,
                          {{"reason", why->message}, {"hint", why->hint}});
}

} // namespace roscell
