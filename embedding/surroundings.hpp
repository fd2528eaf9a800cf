#pragma once

namespace roscell::embedding {

/// Throws node_error (conflict) where the environment of this process, or a
/// file in its working directory, would make DDS do something else than a node
/// needs. Changes nothing.
void check_surroundings();

} // namespace roscell::embedding
