#pragma once

#include "dds/server_ids.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// How often each participant that tells of itself has come back after a
/// silence in which it may have been taken for dead.
///
/// Fast DDS drops who was silent for its lease. Until every server has
/// acknowledged that news it takes the word of who speaks again for an older
/// one, drops it, and never looks at its repetitions: a host that has slept
/// wakes up with all leases over, and with servers that do not hear it yet. So
/// the identity of what is told after each such silence is numbered above all
/// from before. Where nobody was dropped that is a repetition, which nobody
/// looks at. Pure: it is told the time.
class speaker_lives {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// Longer than between two announcements of the programs of a cell, shorter
  /// than their leases.
  static constexpr std::chrono::seconds silence{8};

  /// Of more than these the one that was silent for longest is forgotten.
  static constexpr std::size_t most = 4096;

  /// Numbers of one life are below this.
  static constexpr std::int64_t numbers_a_life = std::int64_t{1} << 32;

  /// It speaks now. Returns what its numbers are to be raised by.
  std::int64_t hear(const guid_prefix& who, time_point now);

private:
  struct speaker {
    time_point heard;
    std::int64_t returns = 0;
  };

  void make_room();

  std::map<guid_prefix, speaker> speakers_;
};

} // namespace roscell
