#include "actors/instances/engine/engine_runtime.hpp"

#include "actors/core/watching.hpp"
#include "actors/edge/engine/build_context.hpp"
#include "actors/instances/engine/engine_parts.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

void on_answered(engine_runtime_pointer self, const engine_answered& x) {
  auto& calls = self->state.calls;
  const auto i = calls.find(x.call);
  if (i == calls.end())
    return;
  const auto then = std::move(i->second);
  calls.erase(i);
  then(x);
}

void on_streamed(engine_runtime_pointer self, const engine_streamed& x) {
  auto& st = self->state;
  if (x.call == st.events_call)
    return on_event_lines(self, x.lines);
  for (auto& [key, work] : st.works)
    if (work.call == x.call)
      return on_build_lines(self, work, x.lines);
}

void on_alarm(engine_runtime_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  if (st.next_attempt && now >= *st.next_attempt)
    watch_events(self);
  else if (st.next_attempt)
    st.timer.set(self, *st.next_attempt);
  release_followers(self);
  report_build_steps(self);
  end_silent_pulls(self);
}

/// Null where the container is not the present one of its instance, or is not
/// known yet to run.
engine_container* present_container(engine_runtime_pointer self,
                                    const std::string& instance,
                                    const std::string& id) {
  auto* x = find_container(self, instance);
  return x != nullptr && !x->settling && x->id == id ? x : nullptr;
}

/// Needs no engine: it may be away while its containers go on.
void fence(engine_runtime_pointer self, const fence_container& request) {
  if (auto* x = present_container(self, request.instance, request.container))
    keep_fence(self->state.config.context, fence_file(self, request.instance),
               request, x->fence_fails);
}

void ask_to_become_stop_safe(engine_runtime_pointer self,
                             const ask_for_safety& request) {
  const auto& instance = request.instance;
  if (present_container(self, instance, request.container) == nullptr)
    return;
  ask_engine(
      self, to_container("POST", request.container, "/kill?signal=SIGUSR1"),
      [=](const engine_answered& x) {
        if (is_good(x))
          return;
        const auto why =
            to_failure(engine_failure("it cannot be signalled", x));
        self->state.config.context.publish_event(
            events::safety_not_asked, instance, {{"reason", why.message}});
      });
}

json describe(const engine_runtime_state& st) {
  return {{"engine", st.config.socket}, {"connected", st.connected},
          {"trouble", st.problem},      {"containers", st.containers.size()},
          {"builds", st.works.size()},  {"followed_logs", st.followers.size()},
          {"calls", st.calls.size()},   {"unwanted", st.unwanted.size()}};
}

} // namespace

engine_runtime_actor::behavior_type
engine_runtime(engine_runtime_pointer self, const engine_runtime_config& config,
               container_listener_actor listener) {
  auto& st = self->state;
  st.config = config;
  st.listener = std::move(listener);
  st.client =
      std::make_unique<engine_client>(config.io, config.socket, config.api);
  watch_until_own_end(self, st.listener);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  clean_build_contexts(config.data_dir / "build");
  watch_events(self);
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [self](const prepare_image& x) { return prepare(self, x); },
      [self](const start_container& x) { return start(self, x); },
      [self](const stop_container& x) { return stop(self, x); },
      [self](const remove_container& x) { return remove(self, x); },
      [self](const adopt_container& x) { return adopt(self, x); },
      [self](const fence_container& x) { fence(self, x); },
      [self](const ask_for_safety& x) { ask_to_become_stop_safe(self, x); },
      [self](const hear_container& x) { hear(self, x.instance); },
      [self](const log_query& x) { return read_log(self, x); },
      [self](const engine_answered& x) { on_answered(self, x); },
      [self](const engine_streamed& x) { on_streamed(self, x); },
      [self](const engine_log_read& x) { on_log_read(self, x); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
