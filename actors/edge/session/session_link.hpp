#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/edge/session/session_handshake.hpp"
#include "actors/edge/session/site_token.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

// The seam on the production path where tests lose, delay, repeat and cut what
// passes between nodes. Without a filter everything passes.

enum class traffic_direction { outgoing, incoming };

/// What becomes of one frame or packet.
struct traffic_verdict {
  enum class action {
    pass,
    drop,   ///< It is lost.
    delay,  ///< It comes later, and so behind what follows it.
    repeat, ///< It comes `times` times in a row.
    cut,    ///< It is lost, and the connection with it. For a heartbeat: drop.
  };

  action what = action::pass;
  std::chrono::milliseconds delay{0};
  unsigned times = 1;
};

/// Called on the io thread for each frame of a session.
using frame_filter =
    std::function<traffic_verdict(traffic_direction, std::string_view text)>;

/// Bounds of one session, see `limits::session`; the same for both sides.
struct session_options {
  size_t max_frame_bytes = limits::session::frame_bytes;
  size_t max_queue_bytes = limits::session::queue_bytes;
  size_t max_undone_frames = limits::session::undone_frames;
  std::chrono::milliseconds handshake_timeout = limits::session::handshake;
  std::chrono::milliseconds close_timeout = limits::session::close;
  std::chrono::milliseconds user_timeout = limits::session::unacknowledged;
  /// Faults for tests; empty in production.
  frame_filter filter;
};

/// Why a session ended.
struct session_end {
  enum class cause {
    closed_here,  ///< `close` was called, or the owner let go of the link.
    closed_there, ///< The peer closed it and said why.
    lost,         ///< The connection broke without a word.
    too_slow,     ///< The queue of outgoing frames ran over.
    violation,    ///< The peer broke the protocol.
  };

  cause why = cause::lost;
  std::string reason; ///< For people; may be a text of the peer.
};

/// Called on the io thread, `on_closed` last and exactly once.
struct session_callbacks {
  /// Takes one frame. `done` may be called from any thread, also later, and
  /// makes room for the next frame; dropping all copies of it does the same.
  std::function<void(std::string text, std::function<void()> done)> on_frame;
  std::function<void(const session_end&)> on_closed;
};

/// One authenticated connection. All methods may be called from any thread,
/// also after the end, when they do nothing. Letting go of the link closes it.
/// An idle link sends nothing at all: the heartbeat tells whether its peer
/// lives.
class session_link {
public:
  virtual ~session_link() = default;

  /// Begins to read. Called once, soon after the link was made: what the peer
  /// sent before is still there, its end included.
  virtual void start(session_callbacks callbacks) = 0;

  /// Queues one frame of UTF-8 text. False if the session is over or the
  /// frame is too large; true promises nothing about its arrival.
  virtual bool send(std::string text) = 0;

  /// Sends what waits, then closes with a reason of up to 120 bytes of ASCII
  /// that the peer gets to see.
  virtual void close(std::string reason) = 0;

  /// Bytes of frames that are not yet written to the socket.
  virtual size_t queued_bytes() const = 0;
};

/// Who is at the other end, as proven by the handshake.
struct session_peer {
  std::string node;
  std::string uuid;
  std::string version;
  std::string address; ///< IPv4 address in dotted form.
  uint16_t port = 0;   ///< TCP port of the connection at the peer's end.
  std::string cell;    ///< The acceptor's cell; empty for a joiner.
  /// The joiner's registration epoch, or the acceptor's incarnation.
  int64_t number = 0;
  /// The joiner's role: `coordinator_role`, or empty. Empty for an acceptor,
  /// which is a coordinator always.
  std::string role{};
};

/// A session that has passed its handshake.
struct established_session {
  std::shared_ptr<session_link> link;
  session_peer peer;
  session_agreement agreement;
  /// How far the time of this node is ahead of the peer's (node_time.hpp), as
  /// both have said before they have proven anything: for the ages that people
  /// see, and nothing else.
  int64_t ahead_ms = 0;
};

/// How a server answers those who want a session.
struct session_acceptor {
  acceptor_identity identity;
  site_secret site;
  session_options options;
  /// Called on the io thread for each session that passed its handshake.
  std::function<void(established_session)> on_session;
  /// Called on the io thread for each one that did not, with the address of
  /// the peer. May be empty.
  std::function<void(const std::string& address, const edge_error&)> on_refused;
};

/// Whom a joiner calls.
struct session_target {
  std::string address; ///< IPv4 address in dotted form.
  uint16_t port = 0;
  std::string expected_cell;   ///< Empty if any cell will do.
  std::string expected_uuid{}; ///< The same of the coordination node.
};

using session_result = edge_result<established_session>;

/// Connects, and proves the site token in both directions. Calls `callback`
/// on the io thread exactly once, within the handshake timeout. Errors:
/// `unreachable`, `timeout`, `unauthorized`, `unknown_cell`, `conflict` for
/// another version, or the code with which the acceptor refused.
void connect_session(io_thread& io, session_target target,
                     joiner_identity identity, const site_secret& site,
                     session_options options,
                     std::function<void(session_result)> callback);

/// Whether whoever takes sessions at `target` proves to have the site token and
/// to be whom the target expects. Calls `callback` on the io thread exactly
/// once, within the handshake timeout, with why it does not; none: it does. It
/// learns what a hello says of who asks, and gets no session.
void ask_for_proof(io_thread& io, session_target target,
                   joiner_identity identity, const site_secret& site,
                   session_options options,
                   std::function<void(std::optional<edge_error>)> callback);

} // namespace roscell
