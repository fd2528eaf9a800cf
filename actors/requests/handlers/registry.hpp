#pragma once

#include "actors/requests/request_registry.hpp"

namespace roscell {

/// Every request of a node: those of a coordination node include the cell's.
request_registry make_registry(bool coordinator);

} // namespace roscell
