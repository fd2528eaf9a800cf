#include "actors/instances/container_supervisor_steps.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/life/instance_text.hpp"
#include "actors/instances/life/skill_instance.hpp"
#include "actors/instances/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/send.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

void on_ended(container_supervisor_pointer self, const std::string& instance,
              supervised_instance& x) {
  x.actor = nullptr;
  const auto error = to_error(deployment_failure(x.row));
  for (auto& promise : std::exchange(x.deployers, {}))
    promise.deliver(error);
  if (x.removing)
    clean_instance(self, instance);
  else
    trim_ended(self);
}

namespace {

/// Empty where there is none.
std::string word_of(const std::map<std::string, std::string>& words,
                    const std::string& instance) {
  const auto i = words.find(instance);
  return i == words.end() ? std::string{} : i->second;
}

/// A program that takes part in DDS is bound to an address of its host.
bool is_bound(const container_supervisor_state& st, const instance_spec& spec) {
  constexpr const char* server = "ROS_DISCOVERY_SERVER";
  return spec.environment.count(server) > 0 || st.environment.count(server) > 0;
}

/// Why an instance must be started again: empty where it was started at this
/// address. To be asked once it is known where it finds the cell now.
std::string renewal_of(const container_supervisor_state& st,
                       const instance_spec& spec) {
  const auto& here = st.config.address;
  const auto there = word_of(st.config.started_at, spec.instance);
  if (there.empty() || there == here || !is_bound(st, spec))
    return {};
  return "the address of this host has changed from " + there + " to " + here;
}

} // namespace

void spawn_actor(container_supervisor_pointer self, supervised_instance& x,
                 bool adopt, const std::string& renewal) {
  auto& st = self->state;
  const auto& id = x.row.spec.instance;
  skill_instance_config config{
      st.config.context,
      caf::actor_cast<container_supervisor_actor>(self),
      st.runtime,
      st.config.store,
      st.config.skills,
      x.skill,
      x.row,
      adopt,
      st.config.builds_images,
      st.config.graph,
      st.environment,
      st.knows_place || !adopt,
      st.config.may_be_lost,
      x.confirmed,
      st.contact_boot_ms,
      st.config.address,
      adopt ? word_of(st.config.started_at, id) : "",
      st.config.boot,
      adopt ? x.started_in : "",
      renewal,
      st.config.write_environment_update,
      st.config.write_parameters,
      st.config.grants,
      st.config.node,
      st.config.secrets};
  if (!renewal.empty())
    st.config.started_at[id] = st.config.address;
  x.actor = spawn(self->system(), st.config.context, skill_instance, config);
  watch_until_its_end(self, x.actor);
  caf::anon_send(x.actor, start_instance{});
  if (x.removing)
    caf::anon_send(x.actor, stop_instance{"removed", x.forced});
}

void start_runtime(container_supervisor_pointer self) {
  auto& st = self->state;
  st.runtime =
      st.config.make_runtime(caf::actor_cast<container_listener_actor>(self));
  watch_until_its_end(self, st.runtime);
}

namespace {

void on_instance_died(container_supervisor_pointer self,
                      const std::string& instance, supervised_instance& x) {
  auto& st = self->state;
  st.config.context.publish_event(events::skill_instance_died, instance,
                                  {{"deaths", x.deaths + 1}});
  if (++x.deaths <= limits::instance::most_deaths)
    return spawn_actor(self, x, true);
  x.row.state = instance_state::failed;
  x.row.since_unix_ms = unix_now_ms();
  x.row.reason = "its supervision has failed";
  if (st.listener)
    self->send(st.listener, instance_changed{x.row});
  // Nobody watches the program any more, so it must not go on.
  caf::anon_send(st.runtime, stop_container{instance, x.row.container, 0});
  if (st.config.secrets)
    caf::anon_send(st.config.secrets, clear_secrets{instance});
  on_ended(self, instance, x);
}

/// Another actor takes up the same program.
void replace_actor(container_supervisor_pointer self, supervised_instance& x,
                   const std::string& renewal = {}) {
  self->demonitor(x.actor.address());
  caf::anon_send_exit(x.actor, caf::exit_reason::kill);
  spawn_actor(self, x, true, renewal);
}

void on_runtime_died(container_supervisor_pointer self,
                     const caf::error& reason) {
  auto& st = self->state;
  if (++st.runtime_deaths > limits::instance::most_deaths)
    return self->quit(reason);
  st.config.context.publish_event(events::runtime_died, st.config.node,
                                  {{"deaths", st.runtime_deaths}});
  start_runtime(self);
  for (auto& [instance, x] : st.instances)
    if (x.actor)
      replace_actor(self, x);
}

} // namespace

void on_down(container_supervisor_pointer self, const caf::down_msg& down) {
  auto& st = self->state;
  if (down.source == st.runtime.address())
    return on_runtime_died(self, down.reason);
  // An instance's actor that ends in order has said why before.
  if (!down.reason)
    return;
  for (auto& [instance, x] : st.instances)
    if (x.actor && x.actor.address() == down.source)
      return on_instance_died(self, instance, x);
}

namespace {

/// What may go to another node hears of every word that reaches the cell, what
/// does not run may wait for one, and of a registration all hear: some may not
/// know yet that they do not run.
bool heeds_contact(const supervised_instance& x, bool registered) {
  return x.actor
         && (registered || x.row.state != instance_state::running
             || x.row.spec.life.on_node_loss.policy == loss_action::move);
}

} // namespace

void take_place(container_supervisor_pointer self,
                const use_environment& place) {
  auto& st = self->state;
  st.environment = place.environment;
  st.knows_place = true;
  for (auto& [instance, x] : st.instances) {
    if (!x.actor)
      continue;
    const auto renewal = renewal_of(st, x.row.spec);
    if (renewal.empty())
      self->send(x.actor, place);
    else
      replace_actor(self, x, renewal);
  }
}

void on_contact(container_supervisor_pointer self,
                const contact_proven& event) {
  auto& known = self->state.contact_boot_ms;
  known = std::max(known, event.boot_ms);
  if (std::exchange(self->state.out_of_contact, false))
    for (auto& [instance, x] : self->state.instances)
      x.confirmed = false;
  for (const auto& instance : event.kept)
    if (auto* x = find_instance(self, instance))
      x->confirmed = true;
  for (const auto& [instance, x] : self->state.instances) {
    if (!heeds_contact(x, !event.kept.empty()))
      continue;
    contact_proven own{event.boot_ms, {}};
    if (x.confirmed)
      own.kept.push_back(instance);
    self->send(x.actor, std::move(own));
  }
}

void on_contact_lost(container_supervisor_pointer self) {
  self->state.out_of_contact = true;
  for (const auto& [instance, x] : self->state.instances)
    if (x.actor)
      self->send(x.actor, contact_lost{});
}

void restore(container_supervisor_pointer self) {
  auto& st = self->state;
  for (auto& row : std::exchange(st.config.restored, {})) {
    if (!is_instance_id(row.spec.instance))
      continue;
    auto& x = st.instances[row.spec.instance];
    x.row = std::move(row);
    x.row.node = st.config.node;
    x.skill = st.config.skills->get()->find(x.row.spec.skill);
    x.started_in = word_of(st.config.started_in, x.row.spec.instance);
    // Nobody knows what it has done meanwhile.
    if (is_live(x.row.state))
      x.row.metrics = {};
    if (is_live(x.row.state))
      spawn_actor(self, x, true,
                  st.environment.empty() ? std::string{}
                                         : renewal_of(st, x.row.spec));
  }
  trim_ended(self);
}

void end_strays(container_supervisor_pointer self) {
  auto& st = self->state;
  for (const auto& instance : std::exchange(st.config.strays, {})) {
    if (!is_instance_id(instance))
      continue;
    const auto context = st.config.context;
    kept_log about;
    about.instance = instance;
    about.node = st.config.node;
    about.reason = "its node knew nothing of it";
    about.ended_unix_ms = unix_now_ms();
    self->request(st.runtime, limits::instance::cleaning,
                  remove_container{instance, {}, false, {about}})
        .then(
            [=](const container_removed&) {
              context.publish_event(events::stray_ended, instance);
            },
            [=](const caf::error& why) {
              context.publish_event(events::stray_removal_failed, instance,
                                    {{"reason", to_failure(why).message}});
            });
  }
}

} // namespace roscell
