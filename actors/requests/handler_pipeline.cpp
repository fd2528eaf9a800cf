#include "actors/requests/handler_pipeline.hpp"

#include "actors/core/watching.hpp"
#include "actors/requests/limits.hpp"
#include "messages/event_kinds.hpp"

#include <caf/typed_response_promise.hpp>

#include <functional>
#include <utility>

namespace roscell {

namespace {

/// Who hears that his task was refused finds none of that name: the coordinator
/// has forgotten it before.
void return_placement_lock(pipeline_pointer self, const node_services& services,
                           const failure& why,
                           std::function<void(const failure&)> done) {
  const auto task = std::exchange(self->state.claimed, {});
  if (task.empty())
    return done(why);
  self->request(services.coordinator, limits::task::rollback,
                record_failure{task, why.message})
      .then([done, why](const task_rolled_back&) { done(why); },
            [done, why](const caf::error&) { done(why); });
}

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
    auto* why = std::get_if<failure>(&result);
    if (why == nullptr) {
      promise.deliver(request_processed{std::get<json>(result).dump()});
      return self->quit();
    }
    services->context.publish_event(events::request_refused,
                                    self->state.request,
                                    {{"handler", self->state.handler},
                                     {"code", why->code},
                                     {"message", why->message}});
    return_placement_lock(self, *services, *why,
                          [self, promise](const failure& x) mutable {
                            promise.deliver(to_error(x));
                            self->quit();
                          });
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
