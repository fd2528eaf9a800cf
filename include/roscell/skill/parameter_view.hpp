#pragma once

#include "roscell/skill/environment.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace roscell::engine {

/// Asks the cell, by the node, to change parameters of this skill while it
/// runs, as `roscell set` does. What becomes of it is told to the view's
/// `on_answer` with the number that this returns; it may be never. May be
/// called by any thread.
/// @param changes JSON object of the parameters that change.
/// @returns 0: it cannot be asked, as where there is no node, or the changes
/// are longer than 3500 bytes.
using request_function =
    std::function<std::int64_t(const std::string& changes)>;

/// Shows a skill's parameters to other programs, by a protocol. There is one
/// for a skill with a parameter that can be changed while it runs, where its
/// program has such a protocol and its step uses that.
class parameter_view {
public:
  virtual ~parameter_view() = default;

  /// Begins to answer. Called once, when the handlers are open. Throws
  /// start_error when that is impossible.
  virtual void open(const parameters& now) = 0;

  /// The executor works with these from now on. May not block.
  virtual void show(const parameters& now) = 0;

  /// What has become of a request; of one that was given up, too. May not
  /// block.
  /// @param problem a sentence; empty: it is done, and was shown before.
  virtual void on_answer(std::int64_t request, const std::string& problem) = 0;

  /// As those of an input_handler.
  virtual void suspend() = 0;
  virtual void resume(const changed_variables& reported) = 0;
};

} // namespace roscell::engine
