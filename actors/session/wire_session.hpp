#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/session/heartbeat_socket.hpp"
#include "actors/edge/session/session_link.hpp"
#include "messages/messages.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

/// The two ways between this node and its peer: the connection, and the
/// heartbeats beside it.
class session_wire {
public:
  std::shared_ptr<session_link> link;
  std::unique_ptr<heartbeat_link> heartbeats;

  /// Keeps the permission to read one frame more until the owner has taken
  /// the frame. Called on the io thread.
  void add_undone(std::function<void()> done);

  /// The oldest of these permissions; empty if there is none.
  std::function<void()> take_undone();

private:
  std::mutex mutex_;
  std::deque<std::function<void()>> undone_;
};

/// Owns one connection to another node.
struct wire_session_state {
  static constexpr const char* name = "session";

  std::shared_ptr<session_wire> wire;
  session_owner_actor owner;
  std::vector<frame_received> early_frames; ///< Came before there was an owner.
  uint32_t heartbeat_sequence = 0;
  std::deque<std::pair<uint32_t, int64_t>>
      heartbeats_sent; ///< Number and time.
  actor_context context;
  uint64_t frames_in = 0;
  uint64_t frames_out = 0;
  std::string peer;
};

/// The SESSION over a WebSocket. Messages: messages/inside/link.hpp.
session_actor::behavior_type
wire_session(session_actor::stateful_pointer<wire_session_state> self,
             const actor_context& context,
             const std::shared_ptr<session_wire>& wire,
             const std::string& peer);

/// Makes the actor of an established session and begins to read.
/// @param heartbeat_port The peer's UDP port; 0 if it is to be learned from
/// heartbeats.
session_actor spawn_session(caf::actor_system& system,
                            const actor_context& context,
                            heartbeat_socket& heartbeats,
                            established_session session,
                            uint16_t heartbeat_port);

} // namespace roscell
