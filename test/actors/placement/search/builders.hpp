#pragma once

#include "actors/placement/search/allocation.hpp"

#include <set>
#include <string>
#include <utility>
#include <vector>

/// Short ways to write a problem down in a test.
namespace roscell::allocation::test {

/// An idle amd64 node.
inline node make_node(std::string name, double cpu, double memory,
                      double disk) {
  node made;
  made.name = std::move(name);
  made.architecture = "amd64";
  made.cpu.capacity = cpu;
  made.memory_mib.capacity = memory;
  made.disk_mib.capacity = disk;
  return made;
}

inline node with_gpu(node host, int index, double memory) {
  host.gpus.push_back({index, {memory, 0}});
  return host;
}

inline node unified(node host) {
  host.unified_memory = true;
  host.gpus.push_back({0, {}});
  return host;
}

inline deployment make_cpu(double cpu, double memory, double disk) {
  deployment made;
  made.name = "cpu";
  made.cpu = cpu;
  made.memory_mib = memory;
  made.disk_mib = disk;
  return made;
}

inline deployment make_gpu(double cpu, double memory, double disk,
                           double gpu_memory) {
  auto made = make_cpu(cpu, memory, disk);
  made.name = "gpu";
  made.needs_gpu = true;
  made.gpu_memory_mib = gpu_memory;
  return made;
}

/// Call last: every node listed so far gets the skill.
inline void add_step(problem& to, std::string id,
                     std::vector<deployment> deployments) {
  step made;
  made.id = std::move(id);
  made.deployments = std::move(deployments);
  for (const auto& host : to.nodes)
    made.nodes_with_skill.insert(host.name);
  to.steps.push_back(std::move(made));
}

/// Node, deployment and GPU index of each step.
using choices = std::vector<std::vector<int>>;

inline choices chosen(const result& answer) {
  choices all;
  for (const auto& one : answer.placements)
    all.push_back({static_cast<int>(one.node), static_cast<int>(one.deployment),
                   one.gpu});
  return all;
}

} // namespace roscell::allocation::test
