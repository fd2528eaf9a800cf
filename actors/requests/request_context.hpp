#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/dds/ros_graph.hpp"
#include "actors/requests/cost/cost_ring.hpp"
#include "actors/requests/request_history.hpp"
#include "messages/failure.hpp"
#include "messages/messages.hpp"

#include <caf/actor_cast.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

/// The actors that handlers may ask. On a primary node there is neither a
/// coordinator nor a scheduler, and no handler that needs one.
struct node_services {
  actor_context context;
  std::string name;          ///< Of the node.
  bool has_identity = false; ///< Its sessions are for nobody else to read.
  cell_coordinator_actor coordinator;
  scheduler_actor scheduler;
  container_supervisor_actor supervisor;
  exec_host_actor execs;       ///< Invalid in tests that run no commands.
  secret_keeper_actor secrets; ///< The same.
  build_keeper_actor keeper;   ///< Invalid in tests that keep none.
  site_keeper_actor site;      ///< Invalid in tests without a site,
  audit_log_actor audit;       ///< and without a disk.
  membership_actor membership;
  node_actor node;
  reach_prober_actor prober;
  /// What the node's discovery server knows; null: it has none.
  std::shared_ptr<ros_graph> graph;
  /// Looks at the node's host, for as long as it takes; null: this program
  /// cannot.
  std::function<findings()> check_host;
  /// What was asked of this node, and what was decided.
  std::shared_ptr<request_history> history =
      std::make_shared<request_history>();
  /// Whoever waits for a change of a task has a copy, which is how they are
  /// counted.
  std::shared_ptr<const void> waiting_places = std::make_shared<char>();
  /// What the node costs.
  std::shared_ptr<cost_meter> costs = std::make_shared<cost_meter>();
};

/// State of a HANDLER PIPELINE.
struct handler_pipeline_state {
  static constexpr const char* name = "handler-pipeline";

  std::string request;                ///< Message type that it works on.
  std::string handler;                ///< The handler that is at work.
  request_history::ticket ticket = 0; ///< 0: its way is not kept.
  /// The task whose placement lock it holds, until it is released; empty: none.
  std::string claimed;
};

using pipeline_pointer =
    handler_pipeline_actor::stateful_pointer<handler_pipeline_state>;

/// What a handler works with besides its input.
struct request_context {
  pipeline_pointer self;
  std::shared_ptr<const node_services> services;

  const actor_context& home() const {
    return services->context;
  }

  request_history& history() const {
    return *services->history;
  }

  /// The handler of that name begins.
  void enter(const char* handler) const {
    self->state.handler = handler;
    history().enter(self->state.ticket, handler, self->clock().now());
  }

  /// Asks an actor, and notes that for the request's trace. One of the two is
  /// called.
  /// @param node the one that the actor speaks for; empty: this one.
  template <class Reply, class Handle, class Message, class OnReply,
            class OnError>
  void call(const Handle& whom, std::chrono::milliseconds timeout,
            Message message, OnReply on_reply, OnError on_error,
            const std::string& node = {}) const {
    const auto asked = history().ask(self->state.ticket, whom ? whom.id() : 0,
                                     node, self->clock().now());
    auto note = [context = *this, asked](bool refused) {
      context.history().answer(asked, refused, context.self->clock().now());
    };
    self->request(whom, timeout, std::move(message))
        .then(
            [note, on_reply](Reply& reply) mutable {
              note(false);
              on_reply(reply);
            },
            [note, on_error](const caf::error& why) mutable {
              note(true);
              on_error(why);
            });
  }
};

/// A reply that ends the whole pipeline at once.
struct early_reply {
  json reply;
};

/// Where a handler's outcome goes: it calls one of these, once.
template <class Out>
class outcome {
public:
  using value_type = std::variant<Out, failure, early_reply>;

  explicit outcome(std::function<void(value_type)> next)
      : next_(std::move(next)) {}

  void deliver(Out value) const {
    next_(std::move(value));
  }

  void fail(failure why) const {
    next_(std::move(why));
  }

  void fail(const caf::error& why) const {
    next_(to_failure(why));
  }

  /// Answers the request without the rest of the pipeline.
  void conclude(json reply) const {
    next_(early_reply{std::move(reply)});
  }

private:
  std::function<void(value_type)> next_;
};

/// One link of a pipeline.
template <class In, class Out>
using handler = void (*)(const request_context&, In, outcome<Out>);

/// Asks an actor on behalf of a handler; an error becomes the outcome.
template <class Reply, class Out, class Handle, class Message, class OnReply>
void ask(const request_context& context, const Handle& whom,
         std::chrono::milliseconds timeout, Message message,
         const outcome<Out>& done, OnReply on_reply) {
  context.call<Reply>(
      whom, timeout, std::move(message),
      [on_reply](Reply& reply) mutable { on_reply(std::move(reply)); },
      [done](const caf::error& why) { done.fail(why); });
}

} // namespace roscell
