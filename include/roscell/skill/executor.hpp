#pragma once

#include "roscell/skill/errors.hpp"
#include "roscell/skill/frame.hpp"
#include "roscell/skill/parameters.hpp"
#include "roscell/skill/safe_state.hpp"

#include <cstddef>
#include <optional>
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

  /// Says, in a sentence without a full stop, why nothing comes of this frame,
  /// where something should: "no CameraInfo has come". Who looks at the skill
  /// reads the last one as soon as nothing has come of some frames in a row.
  void give_nothing(std::string reason) {
    explain(std::move(reason));
  }

private:
  virtual void write(frame result, std::size_t port) = 0;

  virtual void explain(std::string /*reason*/) {
    // Who only keeps results need not care.
  }
};

/// The work of a skill: the one class that its author writes. All calls come
/// from one thread, one at a time. An executor is constructed before the
/// skill reports that it is ready, so slow preparation belongs there; an
/// exception from the constructor ends the skill with a clear line.
class executor {
public:
  virtual ~executor() = default;

  /// Handles one frame and emits any number of results. An exception is
  /// reported and counted, and the next frame follows; too many in a row of one
  /// input, whatever the others bring, end the skill (parameter
  /// `max_failures`), and an unusable_input at once. A call that lasts longer
  /// than the watchdog period counts as hung.
  virtual void process(const frame& input, emitter& output) = 0;

  /// Gives back what the executor holds. Called once, after the last
  /// `process`, while the outputs are still open.
  virtual void release() = 0;

  /// Somebody waits for the skill to be stop-safe, to end it or to move it: it
  /// should come to rest, begin nothing new that must not be broken off, and
  /// call `set_safe(true)`. Called each time the node asks, between two frames,
  /// and only for skills whose descriptor says "safe_state". An exception is
  /// reported.
  virtual void on_safety_wanted() {
    // Who never calls `set_safe` need not care.
  }

  /// Some parameters that the descriptor marks as changeable are to have other
  /// values from the next frame on; `now` is all of them, as they are to be.
  /// Called between two frames. To refuse them, throw: what the exception says
  /// is the reason that the operator reads, and the old ones stay in force, so
  /// read all of them before you change anything. Parameters of the engine and
  /// of inputs and outputs never change.
  virtual void on_parameters(const parameters& now) {
    (void)now;
    throw start_error("this skill does not take parameters while it runs");
  }

protected:
  /// Says whether the skill may be ended now, without harm to what it moves.
  /// May be called from any thread, in the constructor too, and never blocks.
  /// The node hears it within 0.1 s; of what is said more often than every 50
  /// ms the last word counts. It matters where the descriptor says
  /// `"safe_state": true`: until the first `set_safe(true)` such a skill is not
  /// ended but by force, or when its step's `safe_timeout_s` is over.
  void set_safe(bool safe) noexcept {
    safety_.set(safe);
  }

  /// Says which input the skill works on, counted from 0; the others only help
  /// it, as CameraInfo helps with images. The skill's frames, rate and latency
  /// are those of this input and of those of the same data type. To be called
  /// in the constructor; without it that is the first input.
  void set_main_input(std::size_t number) noexcept {
    main_input_ = number;
  }

  /// Says that the skill has sockets of its own, beside its inputs and outputs,
  /// that are bound to an address of this host: where that changes the skill is
  /// started again. To be called in the constructor; without it the skill goes
  /// on, and only its inputs and outputs are made anew.
  void set_bound_to_address() noexcept {
    bound_to_address_ = true;
  }

  /// Says that the frame that `process` has got is kept, to be worked on in a
  /// later call, when one of another input has come: it counts then.
  void set_kept() noexcept {
    kept_ = true;
  }

  /// Says that this call of `process` worked on a frame of this input, counted
  /// from 0, that had been kept.
  void set_worked_on(std::size_t number) noexcept {
    worked_on_ = number;
  }

private:
  friend class primitive_base_engine;

  safe_state safety_;
  bool kept_ = false;
  std::optional<std::size_t> worked_on_;
  bool bound_to_address_ = false;
  std::size_t main_input_ = 0;
};

} // namespace roscell::engine
