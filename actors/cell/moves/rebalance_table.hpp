#pragma once

#include "messages/rebalance.hpp"

#include <chrono>
#include <string>

namespace roscell {

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
