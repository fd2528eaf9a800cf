#pragma once

#include "dds/server_addresses.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

/// INTERNAL to actors/edge/dds: sequence numbers and counts of a discovery
/// server that go on over its restarts. A `number_reserve` owns the file that
/// says which are used; a `number_shift` rewrites one life's messages by it.
namespace roscell {

/// Numbers that no earlier life of this node's discovery server has used.
///
/// Who hears a server remembers by its GUID the last sequence number and the
/// last counts that it has heard, and takes lower ones for repetitions: a
/// server that began at 1 again would not be heard by programs that have
/// outlived its process until it had said as much as the one before. A file
/// says what has been set aside so far; blocks are written before they are
/// used, so that a lost power supply repeats none. May be used by several
/// threads.
class number_reserve {
public:
  /// Who hears a server for the first time goes over all numbers below the
  /// present ones, 0.1 us each, so few of these are set aside at a time.
  static constexpr std::int64_t sequence_block = 256;
  static constexpr std::int64_t count_block = 65536;

  /// What is likely to have been said where no file tells it.
  enum class former_lives {
    many, ///< A server of any version was here for long.
    few,  ///< The node is new, and is unlikely to have taken another's place.
  };

  /// As after this file, in which a later one will look; empty: there is none,
  /// and each life begins at 1. `on_problem` gets, on any thread, why the file
  /// cannot be written.
  explicit number_reserve(
      std::filesystem::path file = {},
      std::function<void(const std::string&)> on_problem = {},
      former_lives before = former_lives::many);

  /// A server begins: its sequence numbers are above the result.
  std::int64_t begin_life();

  /// It uses this sequence number now.
  void use_sequence(std::int64_t number);

  /// A count above all that were ever given.
  std::uint32_t next_count();

private:
  void read(former_lives before);
  void write();

  const std::filesystem::path file_;
  const std::function<void(const std::string&)> on_problem_;
  std::mutex mutex_;                           // Guards what is written.
  std::atomic<std::int64_t> sequences_end_{0}; // Set aside up to here.
  std::atomic<std::int64_t> counts_end_{0};
  std::atomic<std::int64_t> highest_sequence_{0};
  std::atomic<std::int64_t> highest_count_{0};
};

/// Lets a discovery server, which Fast DDS begins at 1 in each life, go on
/// where its last life ended: what it numbers is shifted by what that one has
/// used, and its counts are those of the reserve.
class number_shift {
public:
  /// Takes what it needs for one life.
  number_shift(const guid_prefix& self,
               std::shared_ptr<number_reserve> reserve);

  /// Shifts what a message says of the own writers' numbers.
  void let_out(std::uint8_t* message, std::size_t size) const;

  /// Shifts back what another one says of them. Numbers of earlier lives are
  /// none of this one's: whoever expects such a one has got nothing yet.
  void take_in(std::uint8_t* message, std::size_t size) const;

private:
  const guid_prefix self_;
  const std::shared_ptr<number_reserve> reserve_;
  const std::int64_t begin_;
};

} // namespace roscell
