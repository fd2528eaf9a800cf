#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace roscell::engine {

/// How fast the frames of one stream come, and how old the last one is, by the
/// clock of this process. All members may be called from any thread.
class stream_meter {
public:
  using clock = std::chrono::steady_clock;

  struct measured {
    double rate_hz = 0;
    std::optional<clock::duration> age; ///< None: there was no frame.
  };

  /// Frames are expected from `begin` on.
  explicit stream_meter(clock::time_point begin) : counted_to_(begin) {
    // nop
  }

  void count(clock::time_point now);

  /// All frames.
  std::uint64_t total() const;

  /// The rate of the frames since the value before. It is taken from one frame
  /// to another, so that a slow stream has one rate whenever it is asked for;
  /// where no frame has come the rate is what it can be at most, given the age.
  measured take(clock::time_point now);

private:
  mutable std::mutex mutex_;
  std::uint64_t total_ = 0;
  std::uint64_t frames_ = 0; ///< Since the value before.
  std::optional<clock::time_point> last_;
  clock::time_point counted_to_; ///< The last frame of the value before.
};

/// One for each stream of a step.
class stream_meters {
public:
  using clock = stream_meter::clock;

  stream_meters(std::size_t inputs, std::size_t outputs,
                clock::time_point begin);

  stream_meter& input(std::size_t number) {
    return inputs_[number];
  }

  stream_meter& output(std::size_t number) {
    return outputs_[number];
  }

  std::uint64_t total_in(std::size_t number) const {
    return inputs_[number].total();
  }

  std::uint64_t total_out(std::size_t number) const {
    return outputs_[number].total();
  }

  /// What they have measured, as a node reads it in ROSCELL_STREAMS:
  /// "input:0 29.970 0.033;output:0 0.000 -". A node reads of no more than 16
  /// streams of each direction.
  std::string take_text(clock::time_point now);

private:
  std::deque<stream_meter> inputs_;
  std::deque<stream_meter> outputs_;
};

} // namespace roscell::engine
