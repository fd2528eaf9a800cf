#include "actors/instances/life/runtime_switch.hpp"

#include "actors/core/watching.hpp"

#include <caf/result.hpp>

#include <string_view>
#include <utility>

namespace roscell {

namespace {

using self_pointer = runtime_actor::stateful_pointer<runtime_switch_state>;

/// Also the beginning of the container ids that the runtime of actors gives.
constexpr std::string_view actor_prefix = "actor:";

bool is_of_actor(const std::string& name) {
  return name.compare(0, actor_prefix.size(), actor_prefix) == 0;
}

const runtime_actor& runtime_of(self_pointer self, const std::string& instance,
                                const std::string& container) {
  const auto& st = self->state;
  return is_of_actor(container) || st.in_process.count(instance) != 0
             ? st.actors
             : st.programs;
}

caf::result<container_started> start(self_pointer self,
                                     const start_container& request) {
  auto& st = self->state;
  if (!is_of_actor(request.image)) {
    st.in_process.erase(request.instance);
    return self->delegate(st.programs, request);
  }
  st.in_process.insert(request.instance);
  return self->delegate(st.actors, request);
}

caf::result<container_removed> remove(self_pointer self,
                                      const remove_container& request) {
  auto& st = self->state;
  const auto& runtime = runtime_of(self, request.instance, request.container);
  st.in_process.erase(request.instance);
  return self->delegate(runtime, request);
}

} // namespace

std::string actor_image(const std::string& operation) {
  return std::string{actor_prefix} + operation;
}

runtime_actor::behavior_type runtime_switch(self_pointer self,
                                            runtime_actor programs,
                                            runtime_actor actors,
                                            container_listener_actor listener) {
  auto& st = self->state;
  st.programs = std::move(programs);
  st.actors = std::move(actors);
  watch_until_own_end(self, st.programs);
  watch_until_own_end(self, st.actors);
  watch_until_own_end(self, listener);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) {
        return state_of({{"in_process", self->state.in_process.size()}});
      },
      [self](const prepare_image& x) {
        return self->delegate(self->state.programs, x);
      },
      [self](const start_container& x) { return start(self, x); },
      [self](const stop_container& x) {
        return self->delegate(runtime_of(self, x.instance, x.container), x);
      },
      [self](const remove_container& x) { return remove(self, x); },
      [self](const adopt_container& x) {
        return self->delegate(runtime_of(self, x.instance, x.container), x);
      },
      [self](const hear_container& x) {
        self->send(runtime_of(self, x.instance, {}), x);
      },
      [self](const fence_container& x) {
        self->send(runtime_of(self, x.instance, x.container), x);
      },
      [self](const ask_for_safety& x) {
        self->send(runtime_of(self, x.instance, x.container), x);
      },
      [self](const log_query& x) {
        return self->delegate(runtime_of(self, x.instance, {}), x);
      },
  };
}

} // namespace roscell
