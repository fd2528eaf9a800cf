#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/inside/runtime.hpp"

#include <filesystem>

namespace roscell {

/// Moves the fence in a file on. Where that fails the instance ends in time by
/// itself, so all that is left to do is to tell: by the event `fence_failed`,
/// once until it succeeds again. `fails` keeps how it was.
void keep_fence(const actor_context& context, const std::filesystem::path& file,
                const fence_container& request, bool& fails);

} // namespace roscell
