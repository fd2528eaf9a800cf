#include "actors/instances/fence_keeping.hpp"

#include "actors/edge/process/fence_file.hpp"

#include <utility>

namespace roscell {

void keep_fence(const house& context, const std::filesystem::path& file,
                const fence_container& wish, bool& fails) {
  const auto why = move_fence(file, wish.fence_boot_ms);
  const auto failed_before = std::exchange(fails, why.has_value());
  if (why && !failed_before)
    context.tell("fence_failed", wish.instance,
                 {{"reason", why->message}, {"hint", why->hint}});
}

} // namespace roscell
