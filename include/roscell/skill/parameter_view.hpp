#pragma once

#include "roscell/skill/environment.hpp"

namespace roscell::engine {

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

  /// As those of an input_handler.
  virtual void suspend() = 0;
  virtual void resume(const changed_variables& reported) = 0;
};

} // namespace roscell::engine
