#pragma once

#include <cstddef>

namespace roscell {

/// Raises the process's soft limit of open descriptors to its hard limit, and
/// gives the limit that holds then. The soft one is 1,024 by default, for the
/// sake of programs that use `select`; a node has sockets of members, peers,
/// clients and instances. To be called by a program's `main`: it changes the
/// process, and what the process starts inherits it.
std::size_t raise_descriptor_limit();

} // namespace roscell
