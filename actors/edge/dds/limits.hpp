#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Discovery by DDS. DDS leases decide nothing.
namespace roscell::limits {

namespace unauthenticated_peers {

/// Participants that one node listens to.
constexpr size_t participants = 1024;

/// What is repeated is told again this often, as whoever listens may have had
/// no room for it.
constexpr seconds retelling{60};

} // namespace unauthenticated_peers

namespace discovery {

/// Fast DDS's own periods cost 194 B/s a member, these about 3.
constexpr seconds lease{600};
constexpr seconds announcement_period{200};
/// The most bytes of USER_DATA that we send or look at: enough for the longest
/// names that a session takes, all of whose bytes are escaped.
constexpr size_t announcement_bytes = 1024;
/// So many presences on one host are reached by the host's address alone.
constexpr unsigned presence_places = 4;

} // namespace discovery

} // namespace roscell::limits
