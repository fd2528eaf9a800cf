#pragma once

#include "messages/rebalance.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// How far one step of a move is.
enum class move_stage {
  placed,   ///< Its new place is known, and has its room.
  ordered,  ///< Its old instance is told to end, which is being written down.
  ending,   ///< That is waited for: it may have to be stop-safe first.
  starting, ///< The new instance is started.
  up,       ///< That runs, beside the old one unless that has ended.
  moved,    ///< It has the old one's place.
  over,     ///< It has ended, or its task was: it needs no place.
  undone,   ///< It stays where it was; the old one may have ended.
};

/// A step of a move.
struct moving_step {
  std::string task;
  std::string step;
  std::string node;        ///< Where the old one is.
  bool ends_first = false; ///< The old one ends before the new one starts.
  /// Steps of one task with the same number move together; 0: by itself.
  uint64_t together = 0;
  size_t wave = 0;
  move_stage stage = move_stage::placed;
  /// It does not wait any longer than that until it has ended, and then until
  /// the new one runs.
  std::chrono::steady_clock::time_point deadline =
      std::chrono::steady_clock::time_point::max();
};

/// The move table: of each move that goes on, how far each step is. A move goes
/// in waves: first all steps whose new instances run before the old ones end,
/// then, one after the other, each group in which one ends first. So nothing
/// ends for what has to be stop-safe but that itself. A wave is all or nothing;
/// the first one that does not come up is the last one. Pure; told the time.
///
///     [*] --> placed
///     placed -- its wave, ends first --> ordered -- written --> ending
///     placed -- its wave --> starting
///     ending -- it has surely ended --> starting
///     ending -- the deadline, or nobody knows --> undone
///     starting -- the new one runs --> up
///     starting -- it does not come up, its node is lost --> undone
///     up -- the whole wave is, and that is written down --> moved --> [*]
///     up -- another one of the wave is undone --> undone --> [*]
///     any before moved -- it has ended by itself, or its task was
///                      --> over --> [*]
class move_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  /// A move begins; its waves are as above, or only one.
  uint64_t begin(std::vector<moving_step> steps, bool in_waves);

  /// The next wave begins. Gives its steps that are still placed; empty if
  /// there is none.
  std::vector<size_t> open_wave(uint64_t id);

  /// The steps of the present wave that are at that stage.
  std::vector<size_t> in_wave(uint64_t id, move_stage stage) const;

  /// All steps of it that are at that stage.
  std::vector<size_t> at(uint64_t id, move_stage stage) const;

  /// False if the move has ended, or the step has moved, is over or undone:
  /// then nothing goes on.
  bool enter(uint64_t id, size_t step, move_stage stage, time_point now);

  bool is_at(uint64_t id, size_t step, move_stage stage) const;

  /// Whether its old instance ends first: what it shares files with may have
  /// to.
  bool ends_first(uint64_t id, size_t step) const;

  time_point deadline_of(uint64_t id, size_t step) const;

  /// For what anything waits that moves away from a node, in words; empty: for
  /// nothing.
  std::string waits_on(const std::string& node) const;

  void end(uint64_t id);

  size_t size() const {
    return moves_.size();
  }

private:
  struct move {
    std::vector<moving_step> steps;
    size_t wave = 0; ///< The present one, from 1 on.
    size_t waves = 0;
  };

  const moving_step* find(uint64_t id, size_t step) const;

  std::map<uint64_t, move> moves_;
  uint64_t last_ = 0;
};

/// The moves that bring the cell nearer to its optimum, made one after the
/// other. Pure; told the time.
class rebalance_table {
public:
  using time_point = std::chrono::steady_clock::time_point;

  bool is_running() const {
    return report_.running;
  }

  /// Of the moves that are being made, or were made last.
  const cell_rebalanced& report() const {
    return report_;
  }

  /// Whether what is not stop-safe is waited for.
  bool force() const {
    return force_;
  }

  void begin(cell_rebalanced plan, bool force);

  /// The next move begins; null if there is none, and then all is done.
  const rebalance_move* begin_next();

  /// The step of the present move runs anew as this instance, which is to be
  /// healthy until then.
  void settle(const std::string& instance, time_point until);

  /// The instance that is to stay healthy; empty: there is none.
  const std::string& settling() const {
    return settling_;
  }

  /// The present move is done.
  void complete();

  /// The present move has failed, so that no other one begins.
  void fail(const std::string& problem);

  /// The present move is the last one.
  void stop();

  /// When the instance has been healthy for long enough; max(): none settles.
  time_point next_due() const {
    return due_;
  }

private:
  rebalance_move* current();
  void end();

  cell_rebalanced report_;
  size_t next_ = 0; ///< Position after the present move.
  bool force_ = false;
  bool stopped_ = false;
  std::string settling_;
  time_point due_ = time_point::max();
};

} // namespace roscell
