#include "actors/edge/child_watch.hpp"

#include "actors/edge/notify_socket.hpp"

#include <chrono>
#include <utility>

namespace roscell {

namespace {

/// A program that talks without end causes 50 messages a second at most: what
/// comes in between is merged, or waits in its socket.
constexpr std::chrono::milliseconds words_pause{20};

void hear(int socket, const child_watch::callbacks& calls) {
  const auto words = receive_notifications(socket);
  if (words.ready || words.alive || words.stopping || !words.status.empty())
    calls.on_notification(words);
}

} // namespace

child_watch::child_watch(const std::shared_ptr<io_core>& core, shared_fd pidfd,
                         shared_fd notify_socket, callbacks calls) {
  const auto shared = std::make_shared<const callbacks>(std::move(calls));
  words_ = fd_watch{core, notify_socket,
                    [notify_socket, shared] {
                      hear(notify_socket->get(), *shared);
                      return true;
                    },
                    words_pause};
  end_ = fd_watch{core, std::move(pidfd), [notify_socket, shared] {
                    // What the program said last must not come after its end.
                    hear(notify_socket->get(), *shared);
                    shared->on_end();
                    return false;
                  }};
}

} // namespace roscell
