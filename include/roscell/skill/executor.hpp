#pragma once

#include "roscell/skill/frame.hpp"

#include <cstddef>
#include <string>
#include <utility>

namespace roscell::engine {

/// Takes the results of one `process` call to the outputs. To be called during
/// that call only, by its thread.
class emitter {
public:
  virtual ~emitter() = default;

  /// Writes `result` to output number `port`, counted from 0 in the order of
  /// ROSCELL_OUTPUTS, before it returns. Empty fields are filled in, see
  /// `frame`. Throws std::out_of_range when the step has no such output.
  void emit(frame result, std::size_t port = 0) {
    write(std::move(result), port);
  }

  /// The same for a frame of which only the payload is of interest.
  void emit(std::string payload, std::size_t port = 0) {
    frame result;
    result.payload = std::move(payload);
    write(std::move(result), port);
  }

private:
  virtual void write(frame result, std::size_t port) = 0;
};

/// The work of a skill: the one class that its author writes. All calls come
/// from one thread, one at a time. An executor is constructed before the
/// skill reports that it is ready, so slow preparation belongs there; an
/// exception from the constructor ends the skill with a clear line.
class executor {
public:
  virtual ~executor() = default;

  /// Handles one frame and emits any number of results. An exception is
  /// reported and counted, and the next frame follows; too many in a row end
  /// the skill (parameter `max_failures`). A call that lasts longer than the
  /// watchdog period counts as hung.
  virtual void process(const frame& input, emitter& output) = 0;

  /// Gives back what the executor holds. Called once, after the last
  /// `process`, while the outputs are still open.
  virtual void release() = 0;
};

} // namespace roscell::engine
