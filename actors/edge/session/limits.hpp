#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// The lease, and the wires of a session: frames, heartbeats, proofs, and what
/// is probed.
namespace roscell::limits {

/// How long a silent peer counts as alive. Both sides use the same numbers.
namespace lease {

/// An outage of less than `span - heartbeat_period` is never noticed.
constexpr milliseconds span{8000};
/// A member's heartbeats are this far apart.
constexpr milliseconds heartbeat_period{4000};
/// After a miss the peer is asked again this often,
constexpr milliseconds probe_interval{250};
/// and this often in the last seconds of the lease: 16 questions in all would
/// lose a living member every 14,000 hours where each direction loses 20 %,
/// 24 questions lose it every 50 million hours.
constexpr milliseconds urgent_probe_interval{125};
constexpr milliseconds urgent_span{2000};

} // namespace lease

namespace session {

/// Largest frame, in and out.
constexpr size_t frame_bytes = mib;
/// Frames that wait for a slow peer; beyond it the session is closed.
constexpr size_t queue_bytes = 4 * mib;
/// Frames of the peer that wait for their handler; beyond it nothing is read,
/// and the peer feels it.
constexpr size_t undone_frames = 8;
/// From the first connection attempt to the last frame of the handshake.
constexpr milliseconds handshake{5000};
/// For frames that still wait and the closing handshake of WebSocket.
constexpr milliseconds close{1000};
/// What a listener still reads of a connection that it has refused.
constexpr milliseconds linger{1000};
/// How long sent bytes may stay unacknowledged before the connection is lost.
constexpr milliseconds unacknowledged = lease::span;
/// Of the specs that an answer to a registration carries; half a frame, since
/// JSON escapes some bytes.
constexpr size_t answered_starts_bytes = frame_bytes / 2;

} // namespace session

namespace membership {

/// For one port to answer who finds out why a cell cannot be joined,
constexpr milliseconds probed_port{1500};
/// and for all that is found out.
constexpr milliseconds probed{2500};

} // namespace membership

namespace token {

/// For a registration switch to come with the nonce that it was given.
constexpr seconds nonce_lifetime{10};
/// Nonces that have proven a switch and are not too old yet. More switches in
/// that time are refused.
constexpr size_t spent_nonces = 64;

// Secrets.

/// A site token shorter than this could be guessed.
constexpr size_t least_site_bytes = 16;
constexpr size_t most_bytes = 4 * kib;

} // namespace token

} // namespace roscell::limits
