#pragma once

#include "dds/server_addresses.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

/// INTERNAL to actors/edge/dds: what this node's discovery server keeps of each
/// other one, by its id: which life it speaks with (`server_lives`), and when
/// it may introduce itself again (`introduction_pacing`).
namespace roscell {

/// Which life of each other discovery server this one speaks with.
///
/// A discovery server has the same GUID prefix in every life, because programs
/// are told it in ROS_DISCOVERY_SERVER. Fast DDS keeps by that prefix what the
/// other one has acknowledged, and so takes a new process for the old one, and
/// tells it nothing of what the old one knew. So what comes from another server
/// is given the prefix of its present life before Fast DDS sees it, and what
/// goes to it has the one that it knows again: to Fast DDS each life is another
/// participant.
///
/// A life is four bytes instead of the last four of the prefix; the first one
/// has those that are on the wire. May be used by several threads.
class server_lives {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// So long after it was met nothing is heard of a server that had been lost:
  /// what is on its way, or waits to be read, is of its last life.
  static constexpr std::chrono::milliseconds settling{50};

  explicit server_lives(std::uint8_t own) : own_(own) {}

  /// As Fast DDS knows the present life of server `id`.
  guid_prefix present(std::uint8_t id) const;

  /// The server with that prefix, of any life.
  static std::uint8_t id_of(const guid_prefix& prefix) {
    return prefix[2];
  }

  /// Whether it is the prefix of a server in any life.
  static bool is_server(const guid_prefix& prefix);
  /// And not of the own one.
  bool is_another_server(const guid_prefix& prefix) const;

  /// Its present life has ended, and nothing of it is heard from now on.
  void lose(std::uint8_t id);

  /// It is heard, from now on or after `settling`.
  void meet(std::uint8_t id, time_point now);

  /// Whether something of its present life has been let in.
  bool has_spoken(std::uint8_t id) const {
    return peers_[id].spoken;
  }

  /// Whether it was met, and not lost since.
  bool is_met(std::uint8_t id) const;

  /// Whether it has been lost before.
  bool has_been_lost(std::uint8_t id) const {
    return peers_[id].life != 0;
  }

  /// Nothing is heard of it, but its life goes on.
  void ignore(std::uint8_t id);

  /// Prepares a datagram that has come; false: it is of one that is not heard.
  bool take_in(std::uint8_t* datagram, std::size_t size, time_point now);

  /// Prepares a datagram that shall go; false: it is for a life that has ended.
  bool let_out(std::uint8_t* datagram, std::size_t size) const;

private:
  /// Who was never met is heard: it may be in no cell.
  static constexpr time_point unmet = time_point::min();

  struct peer {
    std::atomic<std::uint32_t> life{0};
    std::atomic<time_point> heard_from{unmet}; ///< max(): never.
    std::atomic<bool> spoken{false};           ///< In this life.
  };

  const std::uint8_t own_;
  std::array<peer, 256> peers_;
};

/// When a discovery server may introduce itself to another one again.
///
/// With each server that it gets to know Fast DDS 2.9.1 introduces itself anew
/// to all, one by one, before it looks at the next one
/// (`DiscoveryDataBase::match_new_server_`): where a whole cell joins at one
/// moment that is the square of its members. So each pause is twice as long as
/// the one before, until there was nothing to say for the longest one. What was
/// not said is not lost: HEARTBEATs follow, and who misses something asks for
/// it. Pure: it is told the time.
class introduction_pacing {
public:
  using time_point = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds first_pause{70};
  static constexpr std::chrono::milliseconds longest_pause{2000};

  /// Whether server `id` is to hear it now.
  bool ask(std::uint8_t id, time_point now);

  /// It begins anew with this server.
  void forget(std::uint8_t id);

private:
  struct pace {
    time_point next = time_point::min();
    std::chrono::milliseconds pause = first_pause;
  };

  std::array<pace, 256> paces_;
};

} // namespace roscell
