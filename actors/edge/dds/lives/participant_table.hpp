#pragma once

#include "dds/server_addresses.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

/// INTERNAL to actors/edge/dds: what a discovery server knows of participants
/// besides Fast DDS: by whom it knows them (`participant_table`), and how often
/// each has come back after a silence (`speaker_lives`). Both are bounded.
namespace roscell {

/// Through whom this node's discovery server knows the participants that it
/// knows, and which of them are in doubt. The diagram is in docs/protocols.md.
///
/// Fast DDS forgets nobody whom another server has told of: if that one ends
/// without a farewell, what it told of stays for ever. Here such participants
/// come into doubt: they go on, because programs outlive a node that ends. The
/// server's next life tells of those that are there, which ends the doubt.
class participant_table {
public:
  /// More than these are not remembered.
  static constexpr std::size_t most = 4096;

  /// Server `id` has told of it.
  void reported_by(std::uint8_t id, const guid_prefix& who);

  /// It has told of itself, so that nobody else is needed to know it.
  void reported_itself(const guid_prefix& who);

  /// It is known.
  void appeared(const guid_prefix& who);

  /// It is not known any more.
  void gone(const guid_prefix& who);

  /// All that server `id` has told of is in doubt.
  void doubt(std::uint8_t id);

  /// Of server `id`, what is in doubt.
  std::vector<guid_prefix> doubted(std::uint8_t id) const;

  /// All that server `id` has told of.
  std::vector<guid_prefix> reported_by(std::uint8_t id) const;

  /// Whether that participant is known by what server `id` has told.
  bool was_reported_by(std::uint8_t id, const guid_prefix& who) const;

private:
  struct reporter {
    std::uint8_t id = 0;
    bool doubted = false;
  };

  std::map<guid_prefix, reporter> reported_;
  std::set<guid_prefix> selves_; // Known by what they tell themselves.
};

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
