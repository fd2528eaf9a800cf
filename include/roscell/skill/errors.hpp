#pragma once

#include <stdexcept>
#include <string>

namespace roscell::engine {

/// How a skill's process ends. The numbers are part of the contract with the
/// node.
enum class exit_code {
  /// The skill was asked to stop, or its inputs came to their end.
  done = 0,
  /// The skill could not start: its configuration or an endpoint is wrong.
  cannot_start = 2,
  /// `process` failed too many times in a row, or for good, or `release`
  /// failed.
  executor_failed = 3,
  /// An input or output broke while the skill ran, e.g. the disk is full.
  stream_failed = 4,
};

/// The skill cannot start. The text is one line that names the place and the
/// remedy.
struct start_error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An input or output broke while the skill ran.
struct stream_error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What an input brings is of no use to this skill, and what follows will be of
/// none either: images in an encoding that it cannot read. Thrown by `process`,
/// it ends the skill with one line and exit code 3. The text goes on after "the
/// input brings", and names the remedy.
struct unusable_input : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The text of the exception that is being handled, of whatever type. To be
/// called in a catch block only: authors of skills may throw anything.
std::string current_error();

} // namespace roscell::engine
