#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/reach/reach_port.hpp"
#include "actors/edge/session/heartbeat_packet.hpp"
#include "actors/edge/session/session_handshake.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/edge/session/site_token.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

/// Called on the io thread for each packet that passes.
using heartbeat_filter =
    std::function<traffic_verdict(traffic_direction, const heartbeat_packet&)>;

struct heartbeat_socket_options {
  std::string address = "127.0.0.1"; ///< IPv4 address of this host.
  uint16_t port = 8420;              ///< The same as of HTTP; 0: a free one.
  heartbeat_filter filter;           ///< Faults for tests.
  /// Of those who are answered when they want to know whether they reach it.
  site_secret site;
};

/// What became of the packets that came in.
struct heartbeat_counters {
  uint64_t accepted = 0;
  uint64_t malformed = 0; ///< Wrong size or unknown kind.
  uint64_t unknown = 0;   ///< No session has the tag.
  uint64_t forged = 0;    ///< The MAC is wrong.
  uint64_t replayed = 0;  ///< Not newer than one that came before.
};

/// One session as far as heartbeats go.
struct heartbeat_registration {
  session_agreement agreement;
  /// Where the peer is, in dotted form. A side that does not know the peer's
  /// port leaves both out: then packets go where the last authentic packet of
  /// the peer came from, and nowhere before there was one.
  std::string address;
  uint16_t port = 0;
  /// Called on the io thread for each authentic packet that is newer than
  /// all others of its kind.
  std::function<void(heartbeat_kind, uint32_t sequence)> on_heartbeat;
};

/// The heartbeats of one session. Letting go of it ends them: at most a
/// callback that is running already then still comes to its end. All methods
/// may be called from any thread.
class heartbeat_link {
public:
  virtual ~heartbeat_link() = default;

  /// Sends one packet, unless `sequence` exceeds heartbeat_packet::max_sequence
  /// or the peer's place is not known. Sequence numbers of one kind must grow.
  virtual void send(heartbeat_kind kind, uint32_t sequence) = 0;
};

/// The one UDP socket of a node for the heartbeats of all its sessions. When to
/// send, and what silence means, is decided elsewhere.
class heartbeat_socket {
public:
  /// Errors: `conflict` if the port is in use, `schema_violation` for an
  /// address that is not this host's, `internal`.
  static edge_result<std::unique_ptr<heartbeat_socket>>
  open(io_thread& io, heartbeat_socket_options options);

  /// Closes the socket.
  virtual ~heartbeat_socket() = default;

  virtual uint16_t port() const = 0;
  virtual std::unique_ptr<heartbeat_link>
  register_session(heartbeat_registration registration) = 0;
  virtual heartbeat_counters counters() const = 0;

  /// From now on `on_heartbeat` is called on the io thread for each packet that
  /// a session of this socket takes.
  virtual void watch(std::function<void()> on_heartbeat) = 0;
};

} // namespace roscell
