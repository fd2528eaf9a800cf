#include "actors/edge/process/process_identity.hpp"
#include "actors/instances/engine/engine_containers.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/failure.hpp"

namespace roscell {

namespace {

using adoption_promise = caf::typed_response_promise<container_adopted>;

void do_adopt(engine_runtime_pointer self, const adopt_container& request,
              adoption_promise promise);
void inspect(engine_runtime_pointer self, const adopt_container& request,
             adoption_promise promise);

/// Its shim is asked first: an engine that ended with its host knows less.
container_adopted ended_container(engine_runtime_pointer self,
                                  const std::string& instance,
                                  const json& found) {
  const auto end = read_exit_record(notify_dir(self, instance));
  container_adopted result{false, text_at(found, "Id"),
                           end ? end->exit_code : exit_code_of(found),
                           end.has_value(), end && end->terminated};
  result.cause = cause_of(found, end, result.exit_code);
  if (end)
    result.most_memory_mib = end->most_memory_mib;
  return result;
}

void on_inspected(engine_runtime_pointer self, const adopt_container& request,
                  const engine_answered& x, adoption_promise promise) {
  const auto& instance = request.instance;
  auto* container = find_container(self, instance);
  const auto found = object_of(x);
  const auto id = text_at(found, "Id");
  const auto state = object_at(found, "State");
  // A node that was killed may know no more than the container of an earlier
  // run; its successor has the instance's name.
  if (!request.container.empty() && !is_lost(x) && !is_running(found))
    return inspect(self, {instance, {}}, promise);
  if (container != nullptr && is_running(found)) {
    if (auto error = open_status(self, instance, *container)) {
      promise.deliver(error);
      return forget(self, instance);
    }
    promise.deliver(container_adopted{true, id, -1});
    return settle(self, instance, id);
  }
  if (is_lost(x))
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, request, promise); });
  else if (!is_good(x) && x.status != 404)
    promise.deliver(engine_failure("the container cannot be looked at", x));
  else if (text_at(state, "Status") == "created")
    // The node ended before it was started.
    promise.deliver(container_adopted{});
  else
    promise.deliver(ended_container(self, instance, found));
  forget(self, instance);
}

void do_adopt(engine_runtime_pointer self, const adopt_container& request,
              adoption_promise promise) {
  if (auto* known = find_container(self, request.instance)) {
    if (known->settling)
      known->waiting.push_back([=] { do_adopt(self, request, promise); });
    else
      promise.deliver(container_adopted{true, known->id, -1});
    return;
  }
  self->state.containers[request.instance].settling = true;
  inspect(self, request, promise);
}

void inspect(engine_runtime_pointer self, const adopt_container& request,
             adoption_promise promise) {
  ask_engine(self,
             to_container("GET", target_of(request.container, request.instance),
                          "/json"),
             [=](const engine_answered& x) {
               on_inspected(self, request, x, promise);
             });
}

} // namespace

caf::result<container_adopted> adopt(engine_runtime_pointer self,
                                     const adopt_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  auto promise = self->make_response_promise<container_adopted>();
  // An exit that nobody hears must not come between looking and listening.
  if (self->state.connected)
    do_adopt(self, request, promise);
  else
    self->state.waiting_adoptions.push_back(
        [=] { do_adopt(self, request, promise); });
  return promise;
}

} // namespace roscell
