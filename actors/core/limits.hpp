#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// What all packages share.
namespace roscell::limits {

/// Pauses between attempts of a node to join, of a coordinator to reach a peer
/// and the like, each twice the one before.
namespace retry {

constexpr milliseconds first{250};
constexpr milliseconds longest{30'000};

} // namespace retry

namespace instance {

/// Most of what is said of why an instance has ended.
constexpr size_t reason_bytes = 2 * kib;

} // namespace instance

namespace membership {

/// How long a name stays with a node that is silent.
constexpr milliseconds name_held{8000};

} // namespace membership

namespace cell {

/// Rows of one cell, whatever their state. Each member has a discovery server
/// whose id is one byte, and the coordinator has one too; ids of coordinators
/// of other cells that it sees are avoided while there are others.
constexpr size_t rows = 250;
/// Nodes that are drained, those that are no rows any more with them.
constexpr size_t drains = 2 * rows;

} // namespace cell

/// What a node counts of itself.
namespace metric {

/// Sets of labels that one family may have.
constexpr size_t label_sets = 512;

} // namespace metric

} // namespace roscell::limits
