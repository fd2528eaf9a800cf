#include "actors/requests/handler_pipeline.hpp"
#include "actors/house/watching.hpp"

#include <caf/typed_response_promise.hpp>

#include <utility>

namespace roscell {

namespace {

caf::result<request_processed>
process(pipeline_pointer self, const request_runner& run,
        const std::shared_ptr<const node_services>& services,
        const json& document) {
  // Who has asked is the router; without it nobody waits for the outcome.
  watch_until_own_end(self, self->current_sender());
  self->state.request = document.at("type").get<std::string>();
  auto promise = self->make_response_promise<request_processed>();
  auto finish = [self, services,
                 promise](std::variant<json, failure> result) mutable {
    if (auto* why = std::get_if<failure>(&result)) {
      services->context.tell("request_refused", self->state.request,
                             {{"handler", self->state.handler},
                              {"code", why->code},
                              {"message", why->message}});
      promise.deliver(to_error(*why));
    } else {
      promise.deliver(request_processed{std::get<json>(result).dump()});
    }
    self->quit();
  };
  run({self, services}, document, std::move(finish));
  return promise;
}

} // namespace

handler_pipeline_actor::behavior_type
handler_pipeline(pipeline_pointer self, const request_runner& run,
                 const std::shared_ptr<const node_services>& services,
                 const std::shared_ptr<const json>& document,
                 request_history::ticket ticket) {
  self->state.ticket = ticket;
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"request", self->state.request},
                         {"handler", self->state.handler}});
      },
      [self, run, services, document](const process_request&) {
        return process(self, run, services, *document);
      },
  };
}

} // namespace roscell
