#pragma once

#include "messages/messages.hpp"
#include "roscell/actor_skill.hpp"

#include <caf/replies_to.hpp>
#include <caf/type_id.hpp>
#include <caf/typed_actor.hpp>

#include <string>

/// What the runtime of actor skills and the keepers of its instances say to
/// each other. The two live in different actor systems: each is spoken to
/// without a sender, so that its own system's workers run it.
namespace roscell::embedding {

/// Opens the streams and makes the instance.
struct begin_skill {};

/// The instance has said that it is ready.
struct skill_ready {};

/// Frames are in the inbox again.
struct frames_waiting {};

/// The instance has said whether it is stop-safe.
struct safety_reported {};

/// Somebody waits for the instance to be stop-safe.
struct safety_wanted {};

/// Ends the instance, after `grace_ms` by force.
struct end_skill {
  int64_t grace_ms = 0;
};

/// An event: the keeper's instance has ended, and its streams are closed.
struct skill_ended {
  std::string instance;
  std::string container;
  int exit_code = 0;
};

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, begin_skill&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, skill_ready&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, frames_waiting&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, safety_reported&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, safety_wanted&) {
  return f();
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, end_skill& x) {
  return f(x.grace_ms);
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, skill_ended& x) {
  return f(x.instance, x.container, x.exit_code);
}

/// The KEEPER of one instance.
using skill_keeper_actor = introspected_actor::extend<
    caf::reacts_to<begin_skill>, caf::reacts_to<skill_ready>,
    caf::reacts_to<frames_waiting>, caf::reacts_to<safety_reported>,
    caf::reacts_to<safety_wanted>, caf::reacts_to<end_skill>,
    // INTERNAL: a sign of life is due.
    caf::reacts_to<caf::tick_atom, uint64_t>>;

/// The RUNTIME of actor skills.
using actor_runtime_actor =
    runtime_actor::extend<caf::reacts_to<skill_ended>,
                          caf::reacts_to<log_grown>,
                          // INTERNAL: alarm number N is due.
                          caf::reacts_to<caf::tick_atom, uint64_t>>;

} // namespace roscell::embedding

CAF_BEGIN_TYPE_ID_BLOCK(roscell_keeper, caf::first_custom_type_id + 1200)
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::begin_skill))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::skill_ready))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::frames_waiting))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::end_skill))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::skill_ended))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::safety_reported))
  CAF_ADD_TYPE_ID(roscell_keeper, (roscell::embedding::safety_wanted))
CAF_END_TYPE_ID_BLOCK(roscell_keeper)
