#pragma once

#include "messages/inside/link.hpp"

#include <chrono>
#include <optional>
#include <string>

namespace roscell {

/// A member sends heartbeats and waits for each ack; a coordinator answers, and
/// asks by itself only when a heartbeat is missing.
enum class lease_side { member, coordinator };

/// One side's belief that the other one lives, for `lease::span` (its number:
/// actors/edge/session/limits.hpp). Pure, told the time: its owner sets a timer
/// to `next()`, calls `due()` then, and leaves it when `next()` moves later.
class lease {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// What there is to do now.
  struct step {
    bool over = false; ///< The peer is lost; the lease must not be asked again.
    std::optional<heartbeat_kind> send;
  };

  lease() = default;

  /// Begins when both sides have just heard each other: the handshake.
  lease(lease_side side, time_point now);

  /// The peer has shown that it lives, by a frame or a heartbeat.
  void heard(time_point now);

  /// As `heard`, and gives what the peer expects in return.
  std::optional<heartbeat_kind> heard_heartbeat(heartbeat_kind kind,
                                                time_point now);

  step due(time_point now);

  time_point next() const {
    return next_;
  }

  time_point last_heard() const {
    return heard_;
  }

private:
  step member_due(time_point now);
  step coordinator_due(time_point now);

  /// When a question sent now is to be repeated.
  time_point repeat_at(time_point now) const;

  time_point end() const;

  lease_side side_ = lease_side::member;
  time_point heard_;
  time_point next_;
  time_point next_heartbeat_;
  bool unanswered_ = false; ///< A heartbeat was sent and nothing heard since.
};

/// Why a peer was given up, in words.
std::string missed_heartbeats_text();

} // namespace roscell
