#include "actors/node/node.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/program_version.hpp"
#include "actors/core/watching.hpp"
#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <utility>

namespace roscell {

namespace {

/// A description whose parts come from several actors.
struct description_draft {
  node_description result;
  size_t open = 3;
  caf::typed_response_promise<node_description> promise;

  void finish_one() {
    if (--open == 0)
      promise.deliver(std::move(result));
  }
};

using shared_draft = std::shared_ptr<description_draft>;

node_description first_draft(node_pointer self, const node_query& query) {
  const auto& parts = self->state.parts;
  node_description result;
  result.identity = parts.identity;
  result.version = program_version;
  result.runtime = parts.config.runtime;
  result.started_unix_ms = self->state.started_unix_ms;
  const auto skills = parts.skills->get();
  result.skills = skills->skills();
  result.refused_skills = skills->published_problems();
  result.limits = parts.limits;
  result.stored_bytes = static_cast<int64_t>(parts.database->bytes_written());
  if (query.actors)
    result.actors = parts.context.directory->rows();
  if (parts.config.coordinator) {
    result.role = node_role::coordinator;
    result.state = node_state::member;
    result.cell = parts.config.cell;
    result.coordinator = parts.identity.address;
    result.environment = parts.edges->environment;
  }
  return result;
}

void ask_membership(node_pointer self, const shared_draft& draft) {
  const auto& membership = self->state.parts.services->membership;
  if (!membership)
    return draft->finish_one();
  self->request(membership, limits::local::part, membership_query{})
      .then(
          [draft](const membership_state& x) {
            draft->result.identity = x.identity;
            draft->result.state = x.state;
            draft->result.cell = x.cell;
            draft->result.coordinator = x.coordinator;
            draft->result.joining = x.joining;
            draft->result.environment = x.environment;
            draft->finish_one();
          },
          [draft](const caf::error&) { draft->finish_one(); });
}

caf::result<node_description> describe(node_pointer self,
                                       const node_query& query) {
  auto draft = std::make_shared<description_draft>();
  draft->result = first_draft(self, query);
  draft->promise = self->make_response_promise<node_description>();
  const auto& parts = self->state.parts;
  self->request(parts.services->supervisor, limits::local::part,
                instance_query{})
      .then(
          [draft](instance_description& x) {
            draft->result.instances = std::move(x.instances);
            draft->finish_one();
          },
          [draft](const caf::error&) { draft->finish_one(); });
  self->request(parts.agent, limits::local::part, resource_query{})
      .then(
          [draft](resource_report& x) {
            draft->result.resources = std::move(x.resources);
            draft->finish_one();
          },
          [draft](const caf::error&) { draft->finish_one(); });
  ask_membership(self, draft);
  return draft->promise;
}

node_hello first_hello(node_pointer self) {
  const auto& parts = self->state.parts;
  node_hello result;
  result.node = parts.identity.name;
  result.version = program_version;
  result.domain_id = parts.config.ros_domain_id;
  result.public_domain = parts.config.public_domain_id;
  if (parts.config.coordinator) {
    result.role = node_role::coordinator;
    result.state = node_state::member;
    result.cell = parts.config.cell;
    result.coordinator = parts.identity.address;
    result.discovery_server = parts.edges->discovery_server;
  }
  return result;
}

/// Only a member knows where its cell is joined.
void introduce(node_hello& result, const membership_state& x) {
  result.state = x.state;
  if (x.state != node_state::member)
    return;
  result.cell = x.cell;
  result.coordinator = x.coordinator;
  result.discovery_server = x.discovery_server;
}

caf::result<node_hello> greet(node_pointer self) {
  auto result = first_hello(self);
  const auto& membership = self->state.parts.services->membership;
  if (!membership)
    return result;
  auto promise = self->make_response_promise<node_hello>();
  self->request(membership, limits::local::part, membership_query{})
      .then(
          [promise, result](const membership_state& x) mutable {
            introduce(result, x);
            promise.deliver(std::move(result));
          },
          [promise](caf::error& why) mutable {
            promise.deliver(std::move(why));
          });
  return promise;
}

/// The last step: instances go on, everything else ends, and the node with it.
void end_children(node_pointer self) {
  auto& parts = self->state.parts;
  for (auto i = parts.children.rbegin(); i != parts.children.rend(); ++i)
    self->send_exit(*i, caf::exit_reason::user_shutdown);
}

/// No new requests; those in progress are told while they can be answered.
/// False if it is stopping already.
bool begin_to_stop(node_pointer self) {
  auto& st = self->state;
  if (std::exchange(st.stopping, true))
    return false;
  st.parts.context.publish_event(events::node_stopping, st.parts.identity.name);
  st.parts.edges->sockets.http->stop([] {});
  self->send_exit(st.parts.router, caf::exit_reason::user_shutdown);
  return true;
}

/// Its cell is told nothing, as if it had crashed, and so keeps its row.
void halt(node_pointer self) {
  if (begin_to_stop(self))
    end_children(self);
}

void stop(node_pointer self) {
  if (!begin_to_stop(self))
    return;
  const auto& st = self->state;
  const auto& membership = st.parts.services->membership;
  if (!membership)
    return end_children(self);
  self->request(membership, limits::membership::leaving,
                leave_cell{"the node is stopping"})
      .then([self](const node_departed&) { end_children(self); },
            [self](const caf::error&) { end_children(self); });
}

void on_child_down(node_pointer self, const caf::down_msg& down) {
  auto& st = self->state;
  if (--st.open_children == 0)
    return self->quit(st.end_reason);
  if (std::exchange(st.stopping, true))
    return;
  st.end_reason = fail(error_code::internal, "a part of the node has died: "
                                                 + to_string(down.reason));
  end_children(self);
}

} // namespace

node_actor::behavior_type node(node_pointer self, const node_parts& parts) {
  self->state.parts = parts;
  self->state.started_unix_ms = unix_now_ms();
  for (const auto& child : parts.children)
    watch_until_its_end(self, child);
  self->state.open_children = parts.children.size();
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_child_down(self, down); });
  self->set_exit_handler([self](const caf::exit_msg&) { halt(self); });
  parts.context.publish_event(
      events::node_started, parts.identity.name,
      {{"address", parts.identity.address}, {"runtime", parts.config.runtime}});
  return {
      [self](const state_query&) {
        const auto& st = self->state;
        return state_of({{"name", st.parts.identity.name},
                         {"stopping", st.stopping},
                         {"children", st.parts.children.size()}});
      },
      [self](const node_query& query) { return describe(self, query); },
      [self](const hello_query&) { return greet(self); },
      [self](const use_settings& x) {
        self->send(self->state.parts.agent, x);
        self->send(self->state.parts.watcher, x);
      },
      [self](const stop_node&) { stop(self); },
  };
}

} // namespace roscell
