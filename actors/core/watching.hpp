#pragma once

#include <caf/actor_cast.hpp>

namespace roscell {

/// `self` gets a down message when `whom`, which may go on for longer, ends.
/// CAF 0.17.6 never takes back what watches somebody: it stays with whom is
/// watched, and keeps the whole memory of an actor that has ended (a weak
/// reference in `default_attachable.hpp`). So this watch is taken back when
/// `self` ends.
template <class Self, class Handle>
void watch_until_own_end(Self* self, const Handle& whom) {
  self->monitor(whom);
  self->attach_functor([self, address = caf::actor_cast<caf::actor_addr>(
                                  whom)] { self->demonitor(address); });
}

/// `self` gets a down message when `whom`, which ends before it, ends.
template <class Self, class Handle>
void watch_until_its_end(Self* self, const Handle& whom) {
  self->monitor(whom);
}

} // namespace roscell
