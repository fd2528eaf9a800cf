#include "actors/instances/container_supervisor_steps.hpp"

#include "actors/edge/limit_units.hpp"
#include "actors/instances/limits.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

void settle_removals(container_supervisor_pointer self) {
  auto& xs = self->state.removals;
  for (auto i = xs.begin(); i != xs.end();) {
    if (!i->left.empty()) {
      ++i;
      continue;
    }
    if (i->error)
      i->promise.deliver(i->error);
    else
      i->promise.deliver(instances_removed{i->gone, i->waiting});
    i = xs.erase(i);
  }
}

void on_gone(container_supervisor_pointer self, const std::string& instance) {
  self->state.instances.erase(instance);
  for (auto& x : self->state.removals)
    if (x.left.erase(instance) > 0)
      x.gone.push_back(instance);
  settle_removals(self);
}

void on_removal_failed(container_supervisor_pointer self,
                       const std::string& instance, const caf::error& error) {
  if (auto* x = find_instance(self, instance))
    x->removing = x->cleaning = false;
  for (auto& x : self->state.removals)
    if (x.left.erase(instance) > 0 && !x.error)
      x.error = error;
  settle_removals(self);
}

safety_wait wait_of(const instance_row& row) {
  return {row.spec.instance,
          row.spec.task,
          row.spec.step,
          row.node,
          row.unsafe_since_unix_ms,
          row.unsafe_until_unix_ms};
}

} // namespace

void on_removal_waits(container_supervisor_pointer self,
                      const instance_row& row) {
  for (auto& x : self->state.removals)
    if (x.left.erase(row.spec.instance) > 0)
      x.waiting.push_back(wait_of(row));
  settle_removals(self);
}

supervised_instance* find_instance(container_supervisor_pointer self,
                                   const std::string& instance) {
  auto& xs = self->state.instances;
  const auto i = xs.find(instance);
  return i == xs.end() ? nullptr : &i->second;
}

// The record goes last: as long as it is there, a restarted node looks for
// what is left.
void clean_instance(container_supervisor_pointer self,
                    const std::string& instance) {
  auto* x = find_instance(self, instance);
  if (x == nullptr || std::exchange(x->cleaning, true))
    return;
  x->removing = true;
  const auto on_error = [=](const caf::error& error) {
    on_removal_failed(self, instance, error);
  };
  const auto drop_record = [=](const container_removed&) {
    self->request(self->state.config.store, limits::instance::disk,
                  store_record{"instances", instance, {}, true})
        .then([=](const record_stored&) { on_gone(self, instance); }, on_error);
  };
  self->request(self->state.runtime, limits::instance::cleaning,
                remove_container{
                    instance, x->row.container, false, {about_log_of(*x)}})
      .then(drop_record, on_error);
}

namespace {

/// Ended instances by their ends, the newest first.
std::vector<std::string> ended_instances(container_supervisor_pointer self) {
  std::vector<std::pair<int64_t, std::string>> ended;
  for (const auto& [instance, x] : self->state.instances)
    if (!is_live(x.row.state) && !x.removing)
      ended.emplace_back(x.row.since_unix_ms, instance);
  std::sort(ended.rbegin(), ended.rend());
  std::vector<std::string> result;
  result.reserve(ended.size());
  for (auto& x : ended)
    result.push_back(std::move(x.second));
  return result;
}

/// Puts an ended instance's log into the history; its row stays.
void drop_log(container_supervisor_pointer self, const std::string& instance,
              supervised_instance& x) {
  if (std::exchange(x.log_dropped, true))
    return;
  x.row.log_tail.clear();
  // One that cannot be removed is tried again with its row.
  self->request(
          self->state.runtime, limits::instance::cleaning,
          remove_container{instance, x.row.container, false, {about_log_of(x)}})
      .then([](const container_removed&) {}, [](const caf::error&) {});
}

/// About what a row takes in a registration.
size_t bytes_of(const instance_row& row) {
  constexpr auto rest = limits::kib;
  size_t result = rest + row.spec.parameters.size() + row.reason.size();
  for (const auto& [name, value] : row.spec.environment)
    result += name.size() + value.size();
  for (const auto& argument : row.spec.arguments)
    result += argument.size();
  for (const auto& secret : row.spec.secrets)
    result += secret.size();
  for (const auto& [variable, secret] : row.spec.secret_env)
    result += variable.size() + secret.size();
  for (const auto* ends : {&row.spec.input, &row.spec.output})
    for (const auto& x : *ends)
      result += x.endpoint.size();
  return result;
}

} // namespace

void trim_ended(container_supervisor_pointer self) {
  size_t kept = 0;
  size_t bytes = 0;
  for (const auto& instance : ended_instances(self)) {
    if (++kept <= limits::instance::most_ended)
      continue;
    auto& x = self->state.instances.at(instance);
    if (!x.acknowledged) {
      bytes += bytes_of(x.row);
      if (bytes <= limits::instance::most_unacknowledged_bytes) {
        drop_log(self, instance, x);
        continue;
      }
    }
    clean_instance(self, instance);
  }
}

void acknowledge_ends(container_supervisor_pointer self,
                      const std::vector<std::string>& instances) {
  for (const auto& instance : instances)
    if (auto* x = find_instance(self, instance);
        x != nullptr && !is_live(x->row.state))
      x->acknowledged = true;
  trim_ended(self);
}

caf::result<instances_removed>
remove_instances(container_supervisor_pointer self,
                 const instance_removal& request) {
  auto& st = self->state;
  pending_removal removal;
  for (const auto& [instance, x] : st.instances)
    if (x.row.spec.task == request.task
        && (request.instance.empty() || request.instance == instance))
      removal.left.insert(instance);
  if (removal.left.empty())
    return instances_removed{};
  auto promise = self->make_response_promise<instances_removed>();
  removal.promise = promise;
  const auto wanted = removal.left;
  st.removals.push_back(std::move(removal));
  for (const auto& instance : wanted) {
    auto& x = st.instances.at(instance);
    x.removing = true;
    x.forced = x.forced || request.force;
    if (x.actor)
      caf::anon_send(x.actor, stop_instance{"removed", x.forced});
    else
      clean_instance(self, instance);
    // It was asked before. One that is gone by now is no loss.
    if (!request.force && x.row.unsafe_since_unix_ms > 0)
      on_removal_waits(self, instance_row{x.row});
  }
  return promise;
}

} // namespace roscell
