#pragma once

#include "actors/house/house.hpp"
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
  house context;
  cell_coordinator_actor coordinator;
  scheduler_actor scheduler;
  container_supervisor_actor supervisor;
  membership_actor membership;
  node_actor node;
};

/// State of a HANDLER PIPELINE.
struct handler_pipeline_state {
  static constexpr const char* name = "handler-pipeline";

  std::string request; ///< Message type that it works on.
  std::string handler; ///< The handler that is at work.
};

using pipeline_pointer =
    handler_pipeline_actor::stateful_pointer<handler_pipeline_state>;

/// What a handler works with besides its input.
struct request_context {
  pipeline_pointer self;
  std::shared_ptr<const node_services> services;

  const house& home() const {
    return services->context;
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
  context.self->request(whom, timeout, std::move(message))
      .then([on_reply](Reply& reply) mutable { on_reply(std::move(reply)); },
            [done](const caf::error& why) { done.fail(why); });
}

} // namespace roscell
