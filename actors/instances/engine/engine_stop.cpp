#include "actors/edge/engine/limits.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <chrono>

namespace roscell {

namespace {

using stop_promise = caf::typed_response_promise<container_stopped>;

void answer_stopped(engine_runtime_pointer self, const std::string& target,
                    stop_promise promise) {
  ask_engine(self, to_container("GET", target, "/json"),
             [promise](const engine_answered& x) mutable {
               promise.deliver(container_stopped{exit_code_of(object_of(x))});
             });
}

void ask_to_stop(engine_runtime_pointer self, const stop_container& request,
                 int64_t grace_ms, stop_promise promise) {
  const auto target = target_of(request.container, request.instance);
  const auto seconds = std::to_string((grace_ms + 999) / 1000);
  ask_engine(self,
             to_container("POST", target, "/stop?t=" + seconds,
                          std::chrono::milliseconds{grace_ms}
                              + limits::instance::force),
             [=](const engine_answered& x) mutable {
               if (is_lost(x))
                 self->state.unwanted.insert(request.instance);
               if (is_good(x) || x.status == 304)
                 answer_stopped(self, target, promise);
               else if (x.status == 404)
                 promise.deliver(container_stopped{});
               else
                 promise.deliver(
                     engine_failure("the container cannot be ended", x));
             });
}

/// Without any grace it is killed first: an engine that waits for a polite end
/// may keep a second request of that kind waiting.
void do_stop(engine_runtime_pointer self, const stop_container& request,
             stop_promise promise) {
  const auto grace_ms = std::clamp<int64_t>(
      request.grace_ms, 0, limits::instance::most_stop_grace.count());
  if (grace_ms > 0)
    return ask_to_stop(self, request, grace_ms, promise);
  ask_engine(self,
             to_container("POST",
                          target_of(request.container, request.instance),
                          "/kill?signal=KILL", limits::engine::probe),
             [=](const engine_answered&) {
               // Whatever came of it: the next answer tells how it is.
               ask_to_stop(self, request, grace_ms, promise);
             });
}

using removal_promise = caf::typed_response_promise<container_removed>;

void drop_container(engine_runtime_pointer self,
                    const remove_container& request, removal_promise promise) {
  const auto target = target_of(request.container, request.instance);
  ask_engine(
      self,
      to_container("DELETE", target, "?force=true&v=true",
                   limits::instance::force),
      [=](const engine_answered& x) mutable {
        if (is_lost(x))
          self->state.unwanted.insert(request.instance);
        // 409: somebody else is removing it. Without an id there may
        // never have been one, and if there was it goes when the engine
        // is back.
        const bool gone = is_good(x) || x.status == 404 || x.status == 409
                          || (is_lost(x) && request.container.empty());
        if (gone) {
          forget(self, request.instance);
          clean_up(self, request.instance);
          promise.deliver(container_removed{});
        } else {
          promise.deliver(engine_failure("the container cannot be removed", x));
        }
      });
}

void do_remove(engine_runtime_pointer self, const remove_container& request,
               removal_promise promise) {
  keep_log(self, request, [=] { drop_container(self, request, promise); });
}

} // namespace

caf::result<container_stopped> stop(engine_runtime_pointer self,
                                    const stop_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  auto promise = self->make_response_promise<container_stopped>();
  auto* x = find_container(self, request.instance);
  if (x != nullptr && x->settling)
    x->waiting.push_back([=] { do_stop(self, request, promise); });
  else
    do_stop(self, request, promise);
  return promise;
}

caf::result<container_removed> remove(engine_runtime_pointer self,
                                      const remove_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  if (!request.restarts)
    self->state.named.erase(request.instance);
  auto promise = self->make_response_promise<container_removed>();
  auto* x = find_container(self, request.instance);
  if (x != nullptr && x->settling)
    x->waiting.push_back([=] { do_remove(self, request, promise); });
  else
    do_remove(self, request, promise);
  return promise;
}

void discard(engine_runtime_pointer self, const std::string& instance) {
  ask_engine(
      self,
      to_container("DELETE", container_name(instance), "?force=true&v=true"),
      [=](const engine_answered& x) {
        if (is_lost(x))
          self->state.unwanted.insert(instance);
        else
          clean_up(self, instance);
      });
}

} // namespace roscell
