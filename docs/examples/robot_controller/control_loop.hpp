#pragma once

#include "arm.hpp"
#include "jitter.hpp"

#include <atomic>
#include <optional>
#include <thread>

/// What passes between the loop and the rest of the program without a lock: the
/// last goal in, the wrist's position out.
class mailbox {
public:
  void write(const position& x);
  position read() const;

private:
  std::atomic<double> x_{0};
  std::atomic<double> y_{0};
  std::atomic<double> z_{0};
};

/// Moves the arm at 1 kHz on a thread of its own, with the priority SCHED_FIFO
/// where this user may have that.
class control_loop {
public:
  /// @param core the only core that the loop runs on; none: any.
  explicit control_loop(std::optional<unsigned> core);
  ~control_loop();

  /// Where the wrist is to go. From any thread.
  void go_to(const position& goal) {
    goal_.write(goal);
  }

  /// Where it is. From any thread.
  position wrist() const {
    return wrist_.read();
  }

  /// Ends the loop, and says how late its cycles began.
  const jitter& stop();

  bool is_real_time() const {
    return real_time_;
  }

private:
  void prepare(std::optional<unsigned> core);
  void run();

  mailbox goal_;
  mailbox wrist_;
  jitter late_;
  std::atomic<bool> stopped_{false};
  std::atomic<bool> real_time_{false};
  std::thread thread_;
};
