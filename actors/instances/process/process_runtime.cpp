#include "actors/instances/process/process_runtime.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/core/watching.hpp"
#include "actors/edge/process/fence_file.hpp"
#include "actors/edge/process/process_identity.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/limits.hpp"
#include "actors/instances/skills/skill_program.hpp"
#include "messages/failure.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <csignal>
#include <utility>

namespace roscell {

namespace {

caf::error bad_id(const std::string& instance) {
  return fail(error_code::engine_failed,
              "'" + instance + "' cannot be the name of a folder");
}

child_watch watch(process_runtime_pointer self, const std::string& instance,
                  const process_instance& x) {
  const auto target = caf::actor_cast<process_runtime_actor>(self);
  const auto listener = self->state.listener;
  child_watch::callbacks calls;
  calls.on_notification = [listener, instance](const notification& n) {
    caf::anon_send(listener, status_notification(instance, n, false));
  };
  calls.on_end = [target, instance, container = x.container] {
    caf::anon_send(target, program_ended{instance, container});
  };
  return {self->state.config.io, x.pidfd, x.notify_socket, std::move(calls)};
}

running_process& keep(process_runtime_pointer self, const std::string& instance,
                      process_instance x) {
  auto& result = self->state.processes[instance];
  result = running_process{};
  if (x.runs())
    result.watch = watch(self, instance, x);
  result.process = std::move(x);
  return result;
}

/// The instance, found on the host if it has not been asked about before.
edge_result<running_process*> known(process_runtime_pointer self,
                                    const std::string& instance,
                                    const std::string& container) {
  auto& xs = self->state.processes;
  if (const auto i = xs.find(instance); i != xs.end())
    return &i->second;
  auto found = take_over(self->state.config, instance, container);
  if (auto* error = std::get_if<edge_error>(&found))
    return *error;
  return &keep(self, instance, std::move(std::get<process_instance>(found)));
}

/// Whether `container` is not the present one of its instance.
bool is_outdated(const running_process& x, const std::string& container) {
  return !container.empty() && x.process.container != container;
}

caf::result<image_prepared> prepare(const prepare_image& request) {
  if (!request.entry_point.empty()) {
    const auto found = find_program(request.skill_dir, request.entry_point);
    if (const auto* error = std::get_if<edge_error>(&found))
      return to_caf(*error);
  }
  const auto same = check_build(request);
  if (const auto* error = std::get_if<edge_error>(&same))
    return to_caf(*error);
  return image_prepared{request.skill_dir};
}

caf::result<container_started> start(process_runtime_pointer self,
                                     const start_container& request) {
  if (!is_instance_id(request.instance) || request.command.empty())
    return bad_id(request.instance);
  // Whatever an earlier run of the node has left must not run twice.
  const auto before = known(self, request.instance, {});
  if (const auto* error = std::get_if<edge_error>(&before))
    return to_caf(*error);
  if (std::get<running_process*>(before)->process.runs())
    return fail(error_code::engine_failed,
                "the instance '" + request.instance + "' runs already");
  auto launched = launch(self->state.config, request);
  if (const auto* error = std::get_if<edge_error>(&launched))
    return to_caf(*error);
  const auto& x = keep(self, request.instance,
                       std::move(std::get<process_instance>(launched)));
  return container_started{x.process.container};
}

caf::result<container_adopted> adopt(process_runtime_pointer self,
                                     const adopt_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  const auto found = known(self, request.instance, request.container);
  if (const auto* error = std::get_if<edge_error>(&found))
    return to_caf(*error);
  const auto& x = std::get<running_process*>(found)->process;
  return container_adopted{x.runs(),         x.container,  x.exit_code,
                           x.recorded,       x.terminated, x.cause,
                           x.most_memory_mib};
}

/// By the io thread, like all words of the instance, so that none overtakes
/// another.
void hear(process_runtime_pointer self, const std::string& instance) {
  const auto& st = self->state;
  const auto forward_notification = [listener = st.listener,
                                     instance](const notification& n) {
    caf::anon_send(listener, status_notification(instance, n, true));
  };
  const auto i = st.processes.find(instance);
  if (i == st.processes.end() || !i->second.process.runs())
    return forward_notification({});
  hear_notifications(st.config.io, i->second.process.notify_socket,
                     forward_notification);
}

void signal(const running_process& x, int number) {
  if (x.process.runs())
    ::pidfd_send_signal(x.process.pidfd->get(), number, nullptr, 0);
}

void ask_to_become_stop_safe(process_runtime_pointer self,
                             const ask_for_safety& request) {
  const auto i = self->state.processes.find(request.instance);
  // The shim passes it on to its command.
  if (i != self->state.processes.end()
      && !is_outdated(i->second, request.container))
    signal(i->second, SIGUSR1);
}

void fence(process_runtime_pointer self, const fence_container& request) {
  const auto& config = self->state.config;
  const auto i = self->state.processes.find(request.instance);
  if (i == self->state.processes.end() || !i->second.process.runs()
      || is_outdated(i->second, request.container))
    return;
  keep_fence(config.context,
             fence_path(config.instances_dir / request.instance), request,
             i->second.fence_fails);
}

/// Goes to the next stage of ending and says when the one after that begins.
void end(process_runtime_pointer self, running_process& x, ending stage,
         alarm::time_point::duration wait) {
  // The shim passes SIGTERM on and turns SIGQUIT into SIGKILL. Where it does
  // not react it is killed itself, and its command dies with it.
  signal(x, stage == ending::asked    ? SIGTERM
            : stage == ending::killed ? SIGQUIT
                                      : SIGKILL);
  x.stage = stage;
  x.next_stage = self->clock().now() + wait;
  self->state.timer.set(self, *x.next_stage);
}

/// Whoever has asked politely may lose his patience: the shortest grace counts.
void hasten(process_runtime_pointer self, running_process& x,
            alarm::time_point::duration grace) {
  const auto due = self->clock().now() + grace;
  if (x.next_stage && due >= *x.next_stage)
    return;
  x.next_stage = due;
  self->state.timer.set(self, due);
}

void give_up(const std::string& instance, running_process& x) {
  const auto why = fail(error_code::engine_failed,
                        "the instance '" + instance + "' cannot be killed", {},
                        "it may hang on a device or a network file system");
  for (auto& promise : std::exchange(x.stoppers, {}))
    promise.deliver(why);
  for (auto& promise : std::exchange(x.removers, {}))
    promise.deliver(why);
  x.stage = ending::none;
  x.next_stage.reset();
}

void advance(process_runtime_pointer self, const std::string& instance,
             running_process& x) {
  constexpr auto wait = limits::instance::force_interval;
  switch (x.stage) {
  case ending::none:
    break;
  case ending::asked:
    return end(self, x, ending::killed, wait);
  case ending::killed:
    return end(self, x, ending::shim_killed, wait);
  case ending::shim_killed:
    return give_up(instance, x);
  }
}

caf::result<container_stopped> stop(process_runtime_pointer self,
                                    const stop_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  const auto found = known(self, request.instance, request.container);
  if (const auto* error = std::get_if<edge_error>(&found))
    return to_caf(*error);
  auto& x = *std::get<running_process*>(found);
  if (is_outdated(x, request.container))
    return container_stopped{};
  if (!x.process.runs())
    return container_stopped{x.process.exit_code};
  const auto grace = std::clamp<int64_t>(
      request.grace_ms, 0, limits::instance::most_stop_grace.count());
  if (x.stage == ending::none)
    end(self, x, ending::asked, std::chrono::milliseconds{grace});
  else if (x.stage == ending::asked)
    hasten(self, x, std::chrono::milliseconds{grace});
  auto promise = self->make_response_promise<container_stopped>();
  x.stoppers.push_back(promise);
  return promise;
}

/// Nothing if all that was left is gone. Where it is started again its folder
/// stays, for its log.
caf::error forget(process_runtime_pointer self, const std::string& instance) {
  auto& st = self->state;
  const auto& x = st.processes.at(instance);
  if (x.goes_on) {
    serve_followers(self, instance);
    return {};
  }
  for (const auto& about : x.about)
    if (about.instance == instance)
      keep_log(st.config, about);
  const auto done = clean_up(st.config, instance);
  st.processes.erase(instance);
  serve_followers(self, instance);
  st.logs.erase(instance);
  if (const auto* error = std::get_if<edge_error>(&done))
    return to_caf(*error);
  return {};
}

caf::result<container_removed> remove(process_runtime_pointer self,
                                      const remove_container& request) {
  if (!is_instance_id(request.instance))
    return bad_id(request.instance);
  const auto found = known(self, request.instance, request.container);
  if (const auto* error = std::get_if<edge_error>(&found))
    return to_caf(*error);
  auto& x = *std::get<running_process*>(found);
  if (is_outdated(x, request.container))
    return container_removed{};
  x.goes_on = request.restarts;
  x.about = request.about;
  if (!x.process.runs()) {
    if (auto error = forget(self, request.instance))
      return error;
    return container_removed{};
  }
  if (x.stage == ending::none || x.stage == ending::asked)
    end(self, x, ending::killed, limits::instance::force_interval);
  auto promise = self->make_response_promise<container_removed>();
  x.removers.push_back(promise);
  return promise;
}

void on_end(process_runtime_pointer self, const program_ended& event) {
  auto& st = self->state;
  const auto i = st.processes.find(event.instance);
  if (i == st.processes.end() || !i->second.process.runs()
      || i->second.process.container != event.container)
    return;
  auto& x = i->second;
  x.watch = {};
  conclude(st.config, event.instance, x.process);
  x.stage = ending::none;
  x.next_stage.reset();
  const auto code = x.process.exit_code;
  self->send(st.listener,
             container_exited{event.instance, event.container, code,
                              x.process.terminated, x.process.cause,
                              x.process.most_memory_mib});
  for (auto& promise : std::exchange(x.stoppers, {}))
    promise.deliver(container_stopped{code});
  serve_followers(self, event.instance);
  auto removers = std::exchange(x.removers, {});
  if (removers.empty())
    return;
  const auto error = forget(self, event.instance);
  for (auto& promise : removers)
    if (error)
      promise.deliver(error);
    else
      promise.deliver(container_removed{});
}

void on_alarm(process_runtime_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (auto& [instance, x] : st.processes) {
    if (x.next_stage && now >= *x.next_stage)
      advance(self, instance, x);
    else if (x.next_stage)
      st.timer.set(self, *x.next_stage);
  }
  release_followers(self);
}

json describe(const process_runtime_state& st) {
  const auto running =
      std::count_if(st.processes.begin(), st.processes.end(),
                    [](const auto& x) { return x.second.process.runs(); });
  return {{"instances", st.processes.size()},
          {"running", running},
          {"followed_logs", st.logs.size()}};
}

} // namespace

process_runtime_actor::behavior_type
process_runtime(process_runtime_pointer self,
                const process_runtime_config& config,
                container_listener_actor listener) {
  self->state.config = config;
  self->state.listener = std::move(listener);
  clear_cgroups(config);
  self->attach_functor([place = config.cgroups] { remove_place(place); });
  watch_until_own_end(self, self->state.listener);
  self->set_down_handler(
      [self](const caf::down_msg& down) { self->quit(down.reason); });
  return {
      [self](const state_query&) { return state_of(describe(self->state)); },
      [](const prepare_image& x) { return prepare(x); },
      [self](const start_container& x) { return start(self, x); },
      [self](const stop_container& x) { return stop(self, x); },
      [self](const remove_container& x) { return remove(self, x); },
      [self](const adopt_container& x) { return adopt(self, x); },
      [self](const fence_container& x) { fence(self, x); },
      [self](const ask_for_safety& x) { ask_to_become_stop_safe(self, x); },
      [self](const hear_container& x) { hear(self, x.instance); },
      [self](const log_query& x) { return read_log(self, x); },
      [self](const program_ended& x) { on_end(self, x); },
      [self](const log_grown& x) { serve_followers(self, x.instance); },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell
