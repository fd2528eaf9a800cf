#pragma once

#include "actors/edge/process/notification.hpp"
#include "messages/inside/runtime.hpp"

#include <string>

namespace roscell {

/// What a program has said at its NOTIFY_SOCKET, as its supervisor is told.
inline instance_notified status_notification(const std::string& instance,
                                             const notification& x,
                                             bool heard) {
  return {instance, x.ready, x.alive,   x.stopping, x.status,
          heard,    x.safe,  x.streams, x.frames,   x.remark};
}

} // namespace roscell
