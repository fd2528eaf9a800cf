#pragma once

#include "messages/codec/json_codec.hpp"

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// What shall become of instances of lower priority where a task does not fit.
struct preemption_options {
  bool preempt = false;
  bool yes = false;
  bool force = false;
};

/// Adds --preempt, --yes and --force.
void add_preemption_options(CLI::App& command, preemption_options& options);

/// Puts into a task request what the options say; another request stays as it
/// is.
void apply(const preemption_options& options, json& request);

} // namespace roscell::cli
