#pragma once

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/limits.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

struct presence_options {
  std::string address; ///< An IPv4 address of this host; nothing else is used.
  std::uint32_t domain_id = 99; ///< Of the site, 0 to 232.
  /// Others to greet directly, where multicast does not reach: "ADDR", for the
  /// first `limits::discovery::presence_places` of that host, or "ADDR:PORT".
  std::vector<std::string> peers;
  std::string
      announcement; ///< At most `limits::discovery::announcement_bytes`.
  /// So long the others remember one that fell silent without a farewell.
  std::chrono::seconds lease = limits::discovery::lease;
  std::chrono::seconds announcement_period =
      limits::discovery::announcement_period; ///< Shorter than the lease.
};

/// Called on a thread of Fast DDS, one at a time for one presence. They must
/// not call the presence.
struct presence_events {
  /// Somebody appeared, or announces something else. Never the own one. What
  /// is repeated is told again now and then, as whoever listens may have had no
  /// room for it.
  std::function<void(const announcement&)> on_seen;
  /// Somebody left, was silent for its lease, or announces another node now;
  /// with what it said last. Not called for the former presence of one that was
  /// killed and has started again, told by its UUID.
  std::function<void(const announcement&)> on_gone;
};

/// A node's presence on the public domain of the site: a participant of simple
/// discovery (multicast 239.255.0.1 with TTL 1, and the given peers) that has
/// no topics and says its announcement, nothing else. Idle, it sends one
/// datagram to the group and to each peer in `announcement_period`.
///
/// Announcements are neither acknowledged nor authenticated: what is seen is a
/// hint about whom to talk to.
class public_presence {
public:
  /// Starts it. Refused with `unreachable` (no such address here),
  /// `schema_violation` (an option is out of bounds) or `internal` (Fast DDS
  /// refuses).
  static edge_result<std::unique_ptr<public_presence>>
  open(const presence_options& options, presence_events events);

  /// Calls `close`.
  ~public_presence();

  public_presence(const public_presence&) = delete;
  public_presence& operator=(const public_presence&) = delete;

  /// Tells all. `schema_violation` when it is too long.
  std::optional<edge_error> update(const std::string& announcement);

  /// Says farewell and ends. Takes a few milliseconds. No event is called any
  /// more when it returns.
  void close();

  /// The UDP port for peers that know this host's address only.
  std::uint16_t port() const;

private:
  class impl;
  explicit public_presence(std::unique_ptr<impl> x);
  std::unique_ptr<impl> impl_;
};

/// How long a survey of `least` waits: on a host that is busy or slow, on which
/// it took longer to open the participant, others need longer to answer, too.
/// Up to 1 s, unless `least` is more.
std::chrono::milliseconds
survey_span(std::chrono::milliseconds least,
            std::chrono::steady_clock::duration opening);

/// What is announced on the site now, each participant once, as far as it
/// answers within `span` (see `survey_span`) and until `enough` is true of one
/// of them; with an empty `enough` it waits out the span. Announces the role
/// `surveyor` meanwhile, whatever `options` say. Blocks; refused like
/// `public_presence::open`.
edge_result<std::vector<announcement>>
survey_site(presence_options options, std::chrono::milliseconds span,
            const std::function<bool(const announcement&)>& enough);

} // namespace roscell
