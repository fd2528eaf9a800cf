#include "tools/roscell/daemon/node_end.hpp"

#include "actors/core/answer_limits.hpp"
#include "actors/core/watching.hpp"
#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"
#include "messages/formation.hpp"
#include "messages/messages.hpp"
#include "tools/roscell/view/format.hpp"

#include <caf/scoped_actor.hpp>
#include <caf/send.hpp>
#include <caf/stateful_actor.hpp>
#include <caf/typed_event_based_actor.hpp>
#include <spdlog/spdlog.h>

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

using stop_clock = std::chrono::steady_clock;

std::string names_of(const std::vector<actor_row>& rows) {
  std::string result;
  for (const auto& x : rows)
    result += (result.empty() ? "" : ", ") + x.name;
  return result;
}

[[noreturn]] void end_by_force(const running_node& node, exit_code code) {
  spdlog::warn("node '{}' is ended before it has stopped in order: {}",
               node.name, names_of(node.actors->rows()));
  _exit(code);
}

/// True if what is waited for ends in time, and no other signal comes.
bool ends_in_time(stop_signals& signals, stop_clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
      deadline - stop_clock::now());
  return signals.wait_for(std::max(left, std::chrono::milliseconds{0}))
         == stop_signals::cause::ended;
}

/// The node has ended; what it leaves behind, such as the answer to a request,
/// gets the rest of the time.
void await_rest(caf::actor_system& system, const running_node& node,
                stop_signals& signals, stop_clock::time_point deadline,
                exit_code code) {
  std::thread rest{[&] {
    system.await_all_actors_done();
    signals.end();
  }};
  if (!ends_in_time(signals, deadline))
    end_by_force(node, code);
  rest.join();
}

void await_end(caf::actor_system& system, const running_node& node,
               stop_signals& signals, exit_code code) {
  const auto deadline = stop_clock::now() + limits::membership::stopping;
  if (!ends_in_time(signals, deadline))
    end_by_force(node, code);
  await_rest(system, node, signals, deadline, code);
}

} // namespace

void empty_node(caf::actor_system& system, const running_node& node,
                stop_signals& signals, std::chrono::milliseconds limit) {
  // What comes too late must not end another wait.
  const auto wanted = std::make_shared<std::atomic<bool>>(true);
  spdlog::info("node '{}' is drained before it stops", node.name);
  drain_first(system, node, [wanted, &signals](const std::string& problem) {
    if (!wanted->exchange(false))
      return;
    if (!problem.empty())
      spdlog::warn("it cannot be drained: {}", printable(problem));
    signals.end();
  });
  const auto end = signals.wait_for(limit);
  if (wanted->exchange(false) && end != stop_signals::cause::ended)
    spdlog::warn("what is left on node '{}' goes on running", node.name);
  undrain(system, node);
}

void stop_in_order(caf::actor_system& system, const running_node& node,
                   stop_signals& signals) {
  spdlog::info("node '{}' stops", node.name);
  caf::anon_send(node.actor, stop_node{});
  await_end(system, node, signals, exit_done);
}

void halt(caf::actor_system& system, const running_node& node,
          stop_signals& signals, exit_code code) {
  caf::anon_send_exit(node.actor, caf::exit_reason::user_shutdown);
  await_end(system, node, signals, code);
}

void await_failed(caf::actor_system& system, const running_node& node,
                  stop_signals& signals) {
  spdlog::error("node '{}' has failed", node.name);
  await_rest(system, node, signals,
             stop_clock::now() + limits::membership::stopping, exit_refused);
}

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
