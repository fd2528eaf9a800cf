#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// The size of a terminal; 0: not known.
struct terminal_size {
  int columns = 0;
  int rows = 0;
};

/// A command that is to run beside an instance.
struct exec_order {
  std::string instance;
  std::string container; ///< Of the instance, by the id that its runtime gave.
  std::string session;   ///< Marks all processes of it, as `exec_variable`.
  std::vector<std::string> command; ///< Not empty.
  bool terminal = false;
  terminal_size size;
};

/// Has all processes of a command be known: none outlives its session.
inline constexpr const char* exec_variable = "ROSCELL_EXEC";

/// The value of TERM with a terminal: what all of them can do.
inline constexpr const char* exec_terminal = "xterm-256color";

/// What comes of a command, as calls on the io thread.
struct exec_callbacks {
  /// It runs.
  std::function<void()> on_started;
  /// A part of its output. Nothing more of that comes before `read_on`.
  std::function<void(bool of_errors, std::string bytes)> on_output;
  /// What was written last has been taken.
  std::function<void()> on_input_taken;
  /// Called once, last: with 128 + n after signal n, and why it was ended or
  /// could not be run, one sentence; empty: it ended by itself.
  std::function<void(int exit_code, std::string reason)> on_end;
};

/// The streams of one command. Letting go of it ends the command with all that
/// it has started, and calls nothing more. Methods may be called from any
/// thread, also after the end.
class exec_channel {
public:
  virtual ~exec_channel() = default;

  /// Not before the bytes that were written last have been taken.
  /// @param last nothing comes after them.
  virtual void write(std::string bytes, bool last) = 0;

  virtual void resize(terminal_size size) = 0;

  virtual void read_on(bool of_errors) = 0;

  /// Ends it for this reason.
  virtual void end(std::string reason) = 0;
};

/// What comes at once of one read, at most.
inline constexpr size_t exec_part_bytes = 64UL * 1024;

} // namespace roscell
