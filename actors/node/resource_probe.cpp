#include "actors/node/resource_probe.hpp"

#include "actors/edge/host/instance_use.hpp"
#include "actors/edge/limits.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using resource_probe_self =
    resource_probe_actor::stateful_pointer<resource_probe_state>;
using clock = host_probe::clock;

/// What our instances use; nothing is read where there are none.
process_usage instance_usage(resource_probe_self self) {
  const auto& st = self->state;
  return usage_of(st.own, st.config.host.root);
}

void mark(resource_probe_self self, clock::time_point now) {
  auto& st = self->state;
  if (!st.probe->sample(now))
    return;
  st.samples.push_back({now, instance_usage(self).cpu_seconds});
  while (st.samples.size() > 1
         && now - st.samples[1].at >= limits::resource::most_sample_age)
    st.samples.pop_front();
}

/// Cores that our instances have used since the newest sample of some age.
double instance_cpu(const resource_probe_state& st, clock::time_point now,
                    double cpu_seconds) {
  for (auto i = st.samples.rbegin(); i != st.samples.rend(); ++i) {
    const std::chrono::duration<double> span = now - i->at;
    if (span >= limits::resource::least_sample_age)
      return std::max(0.0, (cpu_seconds - i->cpu_seconds) / span.count());
  }
  return 0;
}

node_resources convert(const host_resources& host) {
  node_resources result;
  result.architecture = host.architecture;
  result.unified_memory = host.unified_memory;
  result.cpu = host.cpu;
  result.memory_mib = host.memory_mib;
  result.disk_mib = host.disk_mib;
  result.gpus = host.gpus;
  result.devices = host.devices;
  return result;
}

/// Reads the host and takes off what our instances use: they count with what
/// they have reserved instead.
host_measured measure(resource_probe_self self, clock::time_point now) {
  auto& st = self->state;
  ++st.measurements;
  const auto ours = instance_usage(self);
  auto host = st.probe->read(now, ours.pids);
  if (host.cpu_estimated)
    ++st.estimates;
  host.cpu.used =
      std::max(0.0, host.cpu.used - instance_cpu(st, now, ours.cpu_seconds));
  host.memory_mib.used = std::max(0.0, host.memory_mib.used - ours.rss_mib);
  return {convert(apply_bound(std::move(host), st.config.bound))};
}

host_measured answer(resource_probe_self self, const measure_host& request) {
  const auto now = self->clock().now();
  auto& own = self->state.own;
  own.sessions = {request.sessions.begin(), request.sessions.end()};
  own.containers = {request.containers.begin(), request.containers.end()};
  auto result = measure(self, now);
  mark(self, now);
  return result;
}

/// Cores that it has used since it was asked about before. Two questions that
/// follow each other closely get one answer.
double cores_of(resource_probe_state& st, const std::string& instance,
                clock::time_point now, double cpu_s) {
  constexpr std::chrono::milliseconds least_span{500};
  auto& last = st.uses[instance];
  const auto is_first = last.at == clock::time_point{};
  const std::chrono::duration<double> span = now - last.at;
  if (!is_first && span < least_span)
    return last.cpu;
  // Less than before is what another run of it has used.
  const auto cpu =
      is_first || cpu_s < last.cpu_s ? -1 : (cpu_s - last.cpu_s) / span.count();
  last = {now, cpu_s, cpu};
  return cpu;
}

use_measured answer_use(resource_probe_self self, const measure_use& request) {
  auto& st = self->state;
  const auto now = self->clock().now();
  use_measured result;
  result.instances = uses_of(request.instances, st.config.host.root);
  std::map<std::string, use_sample> known;
  for (auto& x : result.instances) {
    if (x.use.cpu_s >= 0)
      x.use.cpu = cores_of(st, x.instance, now, x.use.cpu_s);
    known[x.instance] = st.uses[x.instance];
  }
  st.uses = std::move(known);
  return result;
}

} // namespace

resource_probe_actor::behavior_type
resource_probe(resource_probe_self self, const resource_probe_config& config) {
  self->state.config = config;
  self->state.probe = std::make_unique<host_probe>(config.host);
  mark(self, self->clock().now());
  return {
      [self](const state_query&) {
        return state_of({{"measurements", self->state.measurements},
                         {"estimates", self->state.estimates}});
      },
      [self](const measure_host& request) { return answer(self, request); },
      [self](const measure_use& request) { return answer_use(self, request); },
      [self](const mark_sample&) { mark(self, self->clock().now()); },
  };
}

} // namespace roscell
