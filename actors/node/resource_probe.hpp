#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/host/host_probe.hpp"
#include "actors/edge/host/host_probe_capacity.hpp"
#include "actors/edge/host/instance_use.hpp"
#include "messages/messages.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <string>

namespace roscell {

struct resource_probe_config {
  host_probe_options host;
  capacity_bound bound;
};

/// CPU seconds that our instances had used at some time.
struct instance_sample {
  host_probe::clock::time_point at;
  double cpu_seconds = 0;
};

/// CPU seconds that one instance had used at some time, and how fast then.
struct use_sample {
  host_probe::clock::time_point at;
  double cpu_s = 0;
  double cpu = -1;
};

/// Reads the host when asked. A read of /proc and the first one of NVML can
/// take long, so this actor is spawned as one that blocks.
struct resource_probe_state {
  static constexpr const char* name = "resource-probe";

  resource_probe_config config;
  std::unique_ptr<host_probe> probe;
  own_processes own; ///< Of our instances, as last heard.
  std::deque<instance_sample> samples;
  std::map<std::string, use_sample> uses; ///< By instance, as last asked.
  uint64_t measurements = 0;
  uint64_t estimates = 0; ///< Of these, without a CPU sample in time.
};

/// The RESOURCE PROBE. Messages: messages/inside/agent.hpp. It always answers
/// at once; heartbeats and earlier measurements leave the CPU samples that it
/// needs.
resource_probe_actor::behavior_type resource_probe(
    resource_probe_actor::stateful_pointer<resource_probe_state> self,
    const resource_probe_config& config);

} // namespace roscell
