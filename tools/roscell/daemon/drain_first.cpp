#include "tools/roscell/daemon/drain_first.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/watching.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "messages/formation.hpp"
#include "messages/messages.hpp"

#include <caf/scoped_actor.hpp>
#include <caf/send.hpp>
#include <caf/stateful_actor.hpp>
#include <caf/typed_event_based_actor.hpp>

#include <algorithm>
#include <memory>
#include <utility>

namespace roscell::cli {

namespace {

struct drain_state {
  std::function<void(const std::string&)> done;
  bool drains = false; ///< The coordinator moves what there is.
  bool asking = false;
};

using drain_actor = event_listener_actor;
using drain_pointer = drain_actor::stateful_pointer<drain_state>;

void end(drain_pointer self, const std::string& problem) {
  if (const auto done = std::exchange(self->state.done, nullptr))
    done(problem);
  self->quit();
}

bool has_live(const node_description& node) {
  return std::any_of(node.instances.begin(), node.instances.end(),
                     [](const auto& x) { return is_live(x.state); });
}

/// Checks whether anything is left; asked again when something has changed.
void look(drain_pointer self, const node_actor& node) {
  if (!self->state.drains || std::exchange(self->state.asking, true))
    return;
  self->request(node, limits::local::answer, node_query{})
      .then(
          [self](const node_description& x) {
            self->state.asking = false;
            if (!has_live(x))
              end(self, "");
          },
          [self](const caf::error&) { self->state.asking = false; });
}

void begin(drain_pointer self, const running_node& node) {
  self->request(node.router, limits::request::member_request,
                route_request{message_json(node_drain{node.name}).dump(), "",
                              "the node itself"})
      .then(
          [self, actor = node.actor](const request_routed& reply) {
            if (!reply.refusal.empty())
              return end(self, failure_from(json::parse(reply.text)).message);
            self->state.drains = true;
            look(self, actor);
          },
          [self](const caf::error& why) {
            end(self, to_failure(why).message);
          });
}

drain_actor::behavior_type
drain(drain_pointer self, const running_node& node,
      const std::function<void(const std::string&)>& done) {
  self->state.done = done;
  watch_until_own_end(self, node.events);
  self->set_down_handler([self](const caf::down_msg&) { self->quit(); });
  begin(self, node);
  return {[self, actor = node.actor](const event& e) {
    if (e.what == events::instance_changed)
      look(self, actor);
  }};
}

} // namespace

void drain_first(caf::actor_system& system, const running_node& node,
                 std::function<void(const std::string& problem)> done) {
  const drain_actor listener = system.spawn(drain, node, std::move(done));
  caf::anon_send(node.events, subscribe_events{listener, 0});
}

void undrain(caf::actor_system& system, const running_node& node) {
  caf::scoped_actor self{system};
  self->request(node.router, limits::local::answer,
                route_request{message_json(node_undrain{node.name}).dump(), "",
                              "the node itself"})
      .receive([](const request_routed&) {}, [](const caf::error&) {});
}

} // namespace roscell::cli
