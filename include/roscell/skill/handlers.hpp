#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/frame.hpp"
#include "roscell/skill/stop_event.hpp"

#include <functional>
#include <string>

namespace roscell::engine {

/// What happens to a frame for which the engine's queue has no room.
enum class when_full {
  /// The input waits. For inputs that can be held back, where nothing may be
  /// lost, e.g. files.
  wait,
  /// The oldest frame of the same input is dropped and counted. For live
  /// inputs, where a late frame is worth less than a new one.
  drop_oldest,
};

/// Where an input handler puts its frames.
class frame_sink {
public:
  virtual ~frame_sink() = default;

  /// Takes a frame, from any thread. Returns false when the skill stops; the
  /// frame is then lost and the handler should come to its end.
  virtual bool push(frame input, when_full policy) = 0;
};

/// Writes one line for people, who find it in the instance's log. May be called
/// from any thread.
using say_function = std::function<void(const std::string& line)>;

/// What a handler knows when it is made.
struct stream_context {
  stream config;
  parameters options;
  say_function say;
};

/// Brings the frames of one input into the skill by one protocol.
class input_handler {
public:
  virtual ~input_handler() = default;

  /// Makes ready to receive. Throws start_error when that is impossible. The
  /// skill reports that it is ready when all handlers have been opened.
  virtual void open() = 0;

  /// Pushes frames until the input ends or `stop` is set; called once, on a
  /// thread of its own. Frames may also be pushed from other threads while it
  /// runs. Throws stream_error when the input breaks.
  virtual void run(frame_sink& sink, const stop_event& stop) = 0;

  /// Whether it goes on by `suspend` and `resume` where this host gets another
  /// address. A skill with a handler that does not is started again instead.
  virtual bool survives_new_address() const {
    return false;
  }

  /// Gives up what is bound to an address of this host. Called between two
  /// calls of the executor, by their thread, while `run` goes on.
  virtual void suspend() {
    // Files have no address.
  }

  /// Goes on where these variables lead, once all handlers are suspended.
  /// Throws start_error when that is impossible: the skill then ends.
  virtual void resume(const changed_variables& /*told*/) {
    // Files have no address.
  }
};

/// Carries the results for one output out of the skill by one protocol. All
/// calls come from one thread.
class output_handler {
public:
  virtual ~output_handler() = default;

  /// Makes ready to write. Throws start_error when that is impossible.
  virtual void open() = 0;

  /// Hands one frame over. Throws stream_error when the output is broken.
  virtual void write(const frame& result) = 0;

  /// Hands over what may still be held back. Called once, after the last
  /// `write`. Throws stream_error when that fails.
  virtual void close() = 0;

  /// As those of an input_handler.
  virtual bool survives_new_address() const {
    return false;
  }

  virtual void suspend() {
    // Files have no address.
  }

  virtual void resume(const changed_variables& /*told*/) {
    // Files have no address.
  }
};

} // namespace roscell::engine
