#pragma once

#include "actors/requests/handler_pipeline.hpp"
#include "test/fixture.hpp"

#include <memory>
#include <optional>

namespace roscell::test {

/// There once the request has been answered.
using processed_reply =
    std::shared_ptr<std::optional<caf::expected<request_processed>>>;

/// Has the handler work on a request, and all that arises from it.
template <class Handler>
processed_reply process(virtual_time& time,
                        const std::shared_ptr<node_services>& services,
                        Handler handle, const json& request) {
  request_registry registry;
  registry.add(handle);
  auto result = time.ask<request_processed>(
      spawn(time.system, services->context, handler_pipeline,
            *registry.find(request.at("type").get<std::string>()),
            std::shared_ptr<const node_services>(services),
            std::make_shared<const json>(request), request_history::ticket{0}),
      process_request{});
  time.settle();
  return result;
}

} // namespace roscell::test
