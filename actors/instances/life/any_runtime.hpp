#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/process/notification.hpp"
#include "messages/inside/runtime.hpp"

#include <filesystem>
#include <string>

/// What every runtime of instances does alike.
namespace roscell {

/// Whether the text can be an instance's id: it names folders and containers,
/// so it has letters, digits, '_', '-' and '.' only and does not begin with a
/// dot.
bool is_instance_id(const std::string& text);

/// Moves the fence in a file on. Where that fails the instance ends in time by
/// itself, so all that is left to do is to tell: by the event `fence_failed`,
/// once until it succeeds again. `fails` keeps how it was.
void keep_fence(const actor_context& context, const std::filesystem::path& file,
                const fence_container& request, bool& fails);

/// What a program has said at its NOTIFY_SOCKET, as its supervisor is told.
inline instance_notified status_notification(const std::string& instance,
                                             const notification& x,
                                             bool heard) {
  return {instance, x.ready, x.alive,   x.stopping, x.status,
          heard,    x.safe,  x.streams, x.frames,   x.remark};
}

} // namespace roscell
