#pragma once

#include "actors/requests/handler_pipeline.hpp"
#include "actors/requests/request_context.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <functional>
#include <utility>
#include <variant>

namespace roscell {

/// Asks the coordinator of a member what the node itself does not know. What it
/// has refused for another reason, and what nobody of the cell knows, ends in
/// the node's own refusal.
/// @param known the node's own refusal.
/// @param done called once, with the reply or the refusal.
void ask_coordinator(const request_context& context, const json& request,
                     const failure& known,
                     std::function<void(std::variant<json, failure>)> done);

// Requests that one actor of the node answers as they are.

/// Hands the request to `whom` and waits as long as `timeout` says.
template <class Request, class Reply, class Handle, class Timeout>
pipeline<Request, Reply> forward_to(Handle node_services::*whom,
                                    Timeout timeout_of) {
  return pipeline<Request, Reply>{[=](const request_context& context,
                                      Request request, outcome<Reply> done) {
    const std::chrono::milliseconds timeout = timeout_of(request);
    context.enter("forward");
    ask<Reply>(context, (*context.services).*whom, timeout, std::move(request),
               done, [done](Reply reply) { done.deliver(std::move(reply)); });
  }};
}

/// The same for a request whose answer is never waited for longer.
template <class Request, class Reply, class Handle>
pipeline<Request, Reply> forward_within(std::chrono::milliseconds timeout,
                                        Handle node_services::*whom) {
  return forward_to<Request, Reply>(whom,
                                    [=](const Request&) { return timeout; });
}

/// The same as `forward_to`; what this node does not know a member asks its
/// coordinator.
template <class Request, class Reply, class Handle, class Timeout>
pipeline<Request, Reply> forward_or_ask_cell(Handle node_services::*whom,
                                             Timeout timeout_of) {
  return pipeline<Request, Reply>{[=](const request_context& context,
                                      Request request, outcome<Reply> done) {
    const std::chrono::milliseconds timeout = timeout_of(request);
    context.enter("forward");
    context.template call<Reply>(
        (*context.services).*whom, timeout, request,
        [done](Reply& reply) { done.deliver(std::move(reply)); },
        [context, request, done](const caf::error& why) {
          ask_coordinator(context, message_json(request), to_failure(why),
                          [done](std::variant<json, failure> answer) {
                            if (auto* x = std::get_if<json>(&answer))
                              done.conclude(std::move(*x));
                            else
                              done.fail(std::get<failure>(std::move(answer)));
                          });
        });
  }};
}

} // namespace roscell
