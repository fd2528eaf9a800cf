#pragma once

#include <caf/send.hpp>

#include <utility>

namespace roscell {

/// `whom`, which lives as long as its node, gets `what` after `delay`. The
/// clock keeps both until then, and nobody can take it back: an actor that may
/// end earlier has an `alarm`.
template <class Handle, class Delay, class What>
void send_lasting_actor_later(const Handle& whom, Delay delay, What what) {
  caf::delayed_anon_send(whom, delay, std::move(what));
}

} // namespace roscell
