#include "embedding/skills/actor_runtime.hpp"

#include "actors/core/watching.hpp"
#include "actors/instances/limits.hpp"
#include "messages/failure.hpp"
#include "roscell/ros2.hpp"
#include "roscell/skill/errors.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell::embedding {

namespace {

constexpr std::string_view image_prefix = "actor:";

caf::error does_not_react(const std::string& instance) {
  return fail(error_code::engine_failed,
              "the actor of instance '" + instance
                  + "' does not react; it stays in its program until it does");
}

engine::variable_lookup
lookup_in(const std::map<std::string, std::string>& variables) {
  auto shared =
      std::make_shared<const std::map<std::string, std::string>>(variables);
  return [shared](const char* name) -> const char* {
    const auto i = shared->find(name);
    return i == shared->end() ? nullptr : i->second.c_str();
  };
}

keeper_reports reports_of(actor_runtime_pointer self,
                          const std::string& instance,
                          const std::string& container) {
  keeper_reports result;
  result.notified = [listener =
                         self->state.listener](const instance_notified& x) {
    caf::anon_send(listener, x);
  };
  result.ended = [target = caf::actor_cast<actor_runtime_actor>(self), instance,
                  container](int exit_code) {
    caf::anon_send(target, skill_ended{instance, container, exit_code});
  };
  return result;
}

std::shared_ptr<line_ring> make_log(actor_runtime_pointer self,
                                    const std::string& instance) {
  return std::make_shared<line_ring>(
      self->state.config.log_bytes,
      [target = caf::actor_cast<actor_runtime_actor>(self), instance] {
        caf::anon_send(target, log_grown{instance});
      });
}

/// The streams use what the node says of the cell, not what the environment of
/// this process holds. Throws engine::start_error.
std::shared_ptr<actor_skill_context::impl>
make_side(actor_runtime_pointer self, const start_container& request,
          const std::shared_ptr<line_ring>& log,
          const std::shared_ptr<skill_keeper_actor>& keeper) {
  const auto lookup = lookup_in(request.environment);
  engine::registry protocols;
  ros2::add_ros2_protocol(protocols, lookup);
  return std::make_shared<actor_skill_context::impl>(
      engine::read_environment(lookup), std::move(protocols), self->state.hub,
      log,
      actor_skill_context::impl::ears{
          [keeper] { caf::anon_send(*keeper, skill_ready{}); },
          [keeper] { caf::anon_send(*keeper, frames_waiting{}); },
          [keeper] { caf::anon_send(*keeper, safety_reported{}); }});
}

void start_keeper(actor_runtime_pointer self, const start_container& request,
                  const actor_skill_factory& make, kept_skill& x) {
  auto& st = self->state;
  // The instance's own calls find its keeper here; it is set before there is
  // any, and taken out when the instance has ended, which ends the circle.
  const auto keeper = std::make_shared<skill_keeper_actor>();
  skill_keeper_config config{request.instance,
                             make_side(self, request, x.log, keeper), make,
                             reports_of(self, request.instance, x.container)};
  *keeper = spawn<caf::detached>(*st.config.workers, st.config.context,
                                 skill_keeper, config);
  x.keeper = *keeper;
  caf::anon_send(x.keeper, begin_skill{});
}

caf::result<container_started> start(actor_runtime_pointer self,
                                     const start_container& request) {
  auto& st = self->state;
  const auto make =
      st.config.factories.find(request.image.substr(image_prefix.size()));
  if (make == st.config.factories.end())
    return fail(error_code::engine_failed,
                "this program has no actors for '" + request.image + "'");
  auto& x = st.skills[request.instance];
  if (x.keeper)
    return fail(error_code::engine_failed,
                "the instance '" + request.instance + "' runs already");
  x = kept_skill{};
  x.container = std::string{image_prefix} + std::to_string(++st.starts);
  x.log = make_log(self, request.instance);
  try {
    start_keeper(self, request, make->second, x);
  } catch (...) {
    return fail(error_code::engine_failed, engine::current_error());
  }
  return container_started{x.container};
}

kept_skill* find(actor_runtime_pointer self, const std::string& instance,
                 const std::string& container) {
  auto& xs = self->state.skills;
  const auto i = xs.find(instance);
  return i == xs.end()
                 || (!container.empty() && i->second.container != container)
             ? nullptr
             : &i->second;
}

/// Ends it, by force after the shortest grace that it has been given; what does
/// not react in time is given up, for nobody can end a thread of this program.
void end(actor_runtime_pointer self, kept_skill& x,
         std::chrono::milliseconds grace) {
  caf::anon_send(x.keeper, end_skill{grace.count()});
  const auto until =
      self->clock().now() + grace + limits::instance::force_interval;
  x.patience = x.patience ? std::min(*x.patience, until) : until;
  self->state.timer.set(self, *x.patience);
}

caf::result<container_stopped> stop(actor_runtime_pointer self,
                                    const stop_container& request) {
  auto* x = find(self, request.instance, request.container);
  if (x == nullptr)
    return container_stopped{};
  if (!x->keeper)
    return container_stopped{x->exit_code};
  end(self, *x,
      std::chrono::milliseconds{std::clamp<int64_t>(
          request.grace_ms, 0, limits::instance::most_stop_grace.count())});
  auto promise = self->make_response_promise<container_stopped>();
  x->stoppers.push_back(promise);
  return promise;
}

caf::result<container_removed> remove(actor_runtime_pointer self,
                                      const remove_container& request) {
  auto* x = find(self, request.instance, request.container);
  if (x == nullptr)
    return container_removed{};
  if (!x->keeper) {
    release_followers(*x);
    self->state.skills.erase(request.instance);
    return container_removed{};
  }
  end(self, *x, std::chrono::milliseconds{0});
  auto promise = self->make_response_promise<container_removed>();
  x->removers.push_back(promise);
  return promise;
}

void on_ended(actor_runtime_pointer self, const skill_ended& event) {
  auto& st = self->state;
  auto* x = find(self, event.instance, event.container);
  if (x == nullptr || !x->keeper)
    return;
  x->keeper = nullptr;
  x->patience.reset();
  x->exit_code = event.exit_code;
  self->send(st.listener, container_exited{event.instance, event.container,
                                           event.exit_code});
  for (auto& promise : std::exchange(x->stoppers, {}))
    promise.deliver(container_stopped{event.exit_code});
  release_followers(*x);
  auto removers = std::exchange(x->removers, {});
  if (!removers.empty())
    st.skills.erase(event.instance);
  for (auto& promise : removers)
    promise.deliver(container_removed{});
}

void lose_patience(kept_skill& x, const std::string& instance) {
  x.patience.reset();
  const auto why = does_not_react(instance);
  for (auto& promise : std::exchange(x.stoppers, {}))
    promise.deliver(why);
  for (auto& promise : std::exchange(x.removers, {}))
    promise.deliver(why);
}

void on_alarm(actor_runtime_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  for (auto& [instance, x] : st.skills) {
    if (x.patience && now >= *x.patience)
      lose_patience(x, instance);
    else if (x.patience)
      st.timer.set(self, *x.patience);
    serve_followers(self, x);
  }
}

void on_hear(actor_runtime_pointer self, const std::string& instance) {
  instance_notified answer;
  answer.instance = instance;
  answer.heard = true;
  self->send(self->state.listener, answer);
}

void ask_to_become_stop_safe(actor_runtime_pointer self,
                             const ask_for_safety& request) {
  const auto* x = find(self, request.instance, request.container);
  if (x != nullptr && x->keeper)
    caf::anon_send(x->keeper, safety_wanted{});
}

container_adopted adopt(actor_runtime_pointer self,
                        const adopt_container& request) {
  const auto* x = find(self, request.instance, request.container);
  if (x == nullptr)
    return {false, request.container, -1};
  return {static_cast<bool>(x->keeper), x->container, x->exit_code};
}

/// Nobody is there any more to hear of them, or to end them.
void end_all(actor_runtime_pointer self) {
  for (auto& [instance, x] : self->state.skills)
    if (x.keeper)
      caf::anon_send(
          x.keeper,
          end_skill{
              std::chrono::milliseconds{limits::instance::stop_grace}.count()});
}

} // namespace

actor_runtime_actor::behavior_type
actor_runtime(actor_runtime_pointer self, const actor_runtime_config& config,
              container_listener_actor listener) {
  auto& st = self->state;
  st.config = config;
  st.listener = std::move(listener);
  st.hub = std::make_shared<frame_hub>();
  watch_until_own_end(self, st.listener);
  self->set_down_handler([self](const caf::down_msg& down) {
    end_all(self);
    self->quit(down.reason);
  });
  return {
      [self](const state_query&) {
        return state_of({{"instances", self->state.skills.size()}});
      },
      [](const prepare_image& x) {
        return image_prepared{std::string{image_prefix} + x.operation};
      },
      [self](const start_container& x) { return start(self, x); },
      [self](const stop_container& x) { return stop(self, x); },
      [self](const remove_container& x) { return remove(self, x); },
      [self](const adopt_container& x) { return adopt(self, x); },
      [](const fence_container&) {
        // A step of actors may not say "move": no shim outlives this process.
      },
      [self](const ask_for_safety& x) { ask_to_become_stop_safe(self, x); },
      [self](const hear_container& x) { on_hear(self, x.instance); },
      [self](const log_query& x) { return read_log(self, x); },
      [self](const skill_ended& x) { on_ended(self, x); },
      [self](const log_grown& x) {
        if (auto* skill = find(self, x.instance, {}))
          serve_followers(self, *skill);
      },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.timer.rings(number))
          on_alarm(self);
      },
  };
}

} // namespace roscell::embedding
