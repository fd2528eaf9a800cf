#pragma once

#include "roscell/node_event.hpp"

#include <caf/replies_to.hpp>
#include <caf/type_id.hpp>
#include <caf/typed_actor.hpp>

#include <cstdint>
#include <string>

/// How actors of the program that embeds a node ask it by messages. They may
/// live in another actor system than the node: neither side's workers run the
/// other's actors.
namespace roscell {

/// A request document, as docs/operations.md has them. Asked with a timeout of
/// the caller's own, a second longer than what is asked for may take.
struct node_request {
  std::string json; ///< At most 1 MiB.
};

/// The reply document; that of a refusal has the type "error".
struct node_reply {
  std::string json;
};

using node_event_listener = caf::typed_actor<caf::reacts_to<node_event>>;

/// Wants every event after `since` that is still kept, then each new one, until
/// the listener ends.
struct watch_node {
  node_event_listener listener;
  std::uint64_t since = 0;
};

/// The node is to stop in order. Instances that are programs go on.
struct end_node {};

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, node_request& x) {
  return f(x.json);
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, node_reply& x) {
  return f(x.json);
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, node_event& x) {
  return f(x.sequence, x.time_unix_ms, x.what, x.subject, x.data);
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, watch_node& x) {
  return f(x.listener, x.since);
}

template <class Inspector>
typename Inspector::result_type inspect(Inspector& f, end_node&) {
  return f();
}

/// The node's DOOR. It ends with the node; whoever monitors it hears of that.
/// Errors of a request: those of docs/operations.md, in the reply; a CAF error
/// only when the node has ended.
using node_door_actor =
    caf::typed_actor<caf::replies_to<node_request>::with<node_reply>,
                     caf::reacts_to<watch_node>, caf::reacts_to<end_node>>;

} // namespace roscell

CAF_BEGIN_TYPE_ID_BLOCK(roscell_door, caf::first_custom_type_id + 1100)
  CAF_ADD_TYPE_ID(roscell_door, (roscell::node_request))
  CAF_ADD_TYPE_ID(roscell_door, (roscell::node_reply))
  CAF_ADD_TYPE_ID(roscell_door, (roscell::node_event))
  CAF_ADD_TYPE_ID(roscell_door, (roscell::watch_node))
  CAF_ADD_TYPE_ID(roscell_door, (roscell::end_node))
CAF_END_TYPE_ID_BLOCK(roscell_door)
