#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// How a node becomes a member of a cell, and leaves it.
namespace roscell::limits {

namespace instance {

/// Earlier ends of an instance in a registration, which is one frame.
constexpr size_t registered_ends = 2;

} // namespace instance

namespace membership {

/// Coordinators that were started together appear one after the other; asking
/// all of them at once for places would make the first ones full.
constexpr milliseconds gathering{200};
/// How long a discovery server is looked for before the next pause.
constexpr milliseconds search{5000};
/// After so much silence the address is looked at, to say what is wrong: the
/// answer is there well before 5 s are over.
constexpr milliseconds silence{1500};
/// For a host name to be looked up: resolvers try again after 5 s.
constexpr milliseconds naming{3000};
/// The same problem is told again after the first pause, then after pauses
/// each twice the one before.
constexpr seconds complaint_pause{60};
constexpr minutes longest_complaint_pause{30};
/// Different problems of one series that are told at once.
constexpr size_t complaints = 8;
/// A coordinator that has refused once is unlikely to change its mind soon.
constexpr milliseconds refusal_pause{30'000};

} // namespace membership

namespace unauthenticated_peers {

/// Coordinators that a node which wants a slot remembers.
constexpr size_t slot_arbiters = 64;

} // namespace unauthenticated_peers

namespace discovery {

/// For the names of all peers to be looked up: who waits for discovery has
/// `local::part` for it.
constexpr milliseconds peer_names{2000};

} // namespace discovery

} // namespace roscell::limits
