#pragma once

#include "roscell/node.hpp"

#include <functional>

namespace roscell::embedding {

/// Throws node_error (conflict) where the environment of this process, or a
/// file in its working directory, would make DDS do something else than a node
/// needs. Changes nothing.
void check_surroundings();

/// Runs `work` on a thread of its own with these cores and this nice value, the
/// ordinary scheduling policy and all signals blocked, and waits for it.
/// Threads that it makes have the same, and so have theirs. What `work` throws
/// is thrown. Throws node_error (schema_violation) for cores that this host has
/// not, or may not be used.
void run_on_own_thread(const node_threads& how,
                       const std::function<void()>& work);

} // namespace roscell::embedding
