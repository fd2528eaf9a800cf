#include "embedding/node_door.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/shifted_times.hpp"
#include "actors/core/watching.hpp"
#include "schemas/validator.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>
#include <caf/typed_response_promise.hpp>

#include <utility>

namespace roscell::embedding {

namespace {

using self_pointer = node_door_actor::stateful_pointer<node_door_state>;

/// A sender's workers may be another system's. Without a context of ours CAF
/// has the receiver's own system run it.
void speak_without_workers(self_pointer self) {
  self->context(nullptr);
}

caf::result<node_reply> ask(self_pointer self, const node_request& x) {
  auto promise = self->make_response_promise<node_reply>();
  self->request(self->state.config.router, limits::request::router,
                route_request{x.json, "", "the program around the node"})
      .then(
          [self, promise](request_routed& done) mutable {
            speak_without_workers(self);
            promise.deliver(node_reply{std::move(done.text)});
          },
          [self, promise](const caf::error& why) mutable {
            speak_without_workers(self);
            promise.deliver(why);
          });
  return promise;
}

/// Passes events on to one watcher, and ends with it.
struct event_passer_state {
  static constexpr const char* name = "event-passer";
};

event_listener_actor::behavior_type
event_passer(event_listener_actor::stateful_pointer<event_passer_state> self,
             const node_event_listener& to) {
  watch_until_own_end(self, to);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  return {
      [to](const event& x) {
        caf::anon_send(to,
                       node_event{x.sequence, to_wall_clock()(x.time_unix_ms),
                                  x.what, x.subject, x.data});
      },
  };
}

void watch(self_pointer self, const watch_node& x) {
  const auto passer = self->system().spawn(event_passer, x.listener);
  caf::anon_send(self->state.config.events, subscribe_events{passer, x.since});
}

} // namespace

node_door_actor::behavior_type node_door(self_pointer self,
                                         const node_door_config& config) {
  self->state.config = config;
  watch_until_own_end(self, config.node);
  self->set_down_handler([self](const caf::down_msg& down) {
    // Whoever monitors it is told by this thread.
    speak_without_workers(self);
    self->quit(down.reason);
  });
  return {
      [self](const node_request& x) { return ask(self, x); },
      [self](const watch_node& x) { watch(self, x); },
      [self](const end_node&) {
        self->send(self->state.config.node, stop_node{});
      },
  };
}

} // namespace roscell::embedding
