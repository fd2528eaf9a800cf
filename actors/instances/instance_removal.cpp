#include "actors/instances/instance_removal.hpp"

#include "actors/house/limits.hpp"

#include <caf/result.hpp>
#include <caf/send.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace roscell {

namespace {

using self_pointer = container_supervisor_pointer;

void settle_removals(self_pointer self) {
  auto& xs = self->state.removals;
  for (auto i = xs.begin(); i != xs.end();) {
    if (!i->left.empty()) {
      ++i;
      continue;
    }
    if (i->error)
      i->promise.deliver(i->error);
    else
      i->promise.deliver(instances_removed{i->gone});
    i = xs.erase(i);
  }
}

void on_gone(self_pointer self, const std::string& instance) {
  self->state.instances.erase(instance);
  for (auto& x : self->state.removals)
    if (x.left.erase(instance) > 0)
      x.gone.push_back(instance);
  settle_removals(self);
}

void on_removal_failed(self_pointer self, const std::string& instance,
                       const caf::error& error) {
  if (auto* x = find_instance(self, instance))
    x->removing = x->cleaning = false;
  for (auto& x : self->state.removals)
    if (x.left.erase(instance) > 0 && !x.error)
      x.error = error;
  settle_removals(self);
}

} // namespace

supervised_instance* find_instance(self_pointer self,
                                   const std::string& instance) {
  auto& xs = self->state.instances;
  const auto i = xs.find(instance);
  return i == xs.end() ? nullptr : &i->second;
}

// The record goes last: as long as it is there, a restarted node looks for
// what is left.
void clean_instance(self_pointer self, const std::string& instance) {
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
                remove_container{instance, x->row.container})
      .then(drop_record, on_error);
}

void trim_ended(self_pointer self) {
  std::vector<std::pair<int64_t, std::string>> ended;
  for (const auto& [instance, x] : self->state.instances)
    if (!is_live(x.row.state) && !x.removing)
      ended.emplace_back(x.row.since_unix_ms, instance);
  if (ended.size() <= limits::instance::most_ended)
    return;
  std::sort(ended.begin(), ended.end());
  ended.resize(ended.size() - limits::instance::most_ended);
  for (const auto& x : ended)
    clean_instance(self, x.second);
}

caf::result<instances_removed> remove_instances(self_pointer self,
                                                const instance_removal& wish) {
  auto& st = self->state;
  pending_removal removal;
  for (const auto& [instance, x] : st.instances)
    if (x.row.spec.task == wish.task
        && (wish.instance.empty() || wish.instance == instance))
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
    if (x.actor)
      caf::anon_send(x.actor, stop_instance{"removed"});
    else
      clean_instance(self, instance);
  }
  return promise;
}

} // namespace roscell
