#pragma once

#include "actors/requests/request_registry.hpp"

#include <chrono>
#include <utility>

/// Requests that one actor of the node answers as they are.
namespace roscell {

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

} // namespace roscell
