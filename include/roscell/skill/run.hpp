#pragma once

#include "roscell/skill/registry.hpp"

#include <string>

namespace roscell::engine {

/// The whole `main` of a skill: reads the environment, runs the engine until
/// its inputs end or SIGTERM or SIGINT arrives, and returns the exit code (see
/// errors.hpp). Must be called before the process starts a thread. The only
/// argument it knows is `--help`.
int run(const registry& parts, int argc, char** argv);

/// The same for a skill with one executor, registered for one model.
template <class Executor>
int run(const std::string& model, int argc, char** argv) {
  registry parts;
  parts.add_executor<Executor>(model);
  return run(parts, argc, argv);
}

} // namespace roscell::engine
