#include "actors/placement/search/occupancy.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

/// Use above capacity counts as full.
double used(const amount& of) {
  return std::min(of.used, of.capacity);
}

double free(const amount& of) {
  return of.capacity - used(of);
}

} // namespace

occupancy::occupancy(const problem& asked) : asked_(asked) {
  rooms_.reserve(asked.nodes.size());
  for (const auto& node : asked.nodes) {
    room here;
    here.cpu = free(node.cpu);
    here.memory = free(node.memory_mib);
    here.disk = free(node.disk_mib);
    here.cpu_used = used(node.cpu);
    here.memory_used = used(node.memory_mib);
    for (const auto& card : node.gpus)
      here.gpus.push_back(free(card.memory_mib));
    rooms_.push_back(std::move(here));
  }
}

shares occupancy::shares_of(const deployment& way,
                            const candidate& choice) const {
  const auto& here = rooms_[choice.node];
  shares all;
  all.of[cpu] = {way.cpu, here.cpu};
  all.of[memory] = {way.memory_mib, here.memory};
  all.of[disk] = {way.disk_mib, here.disk};
  if (choice.gpu < 0)
    return all;
  all.count = 4;
  if (asked_.nodes[choice.node].unified_memory) {
    all.of[memory].free -= way.gpu_memory_mib;
    all.of[gpu_memory] = {way.gpu_memory_mib, here.memory - way.memory_mib};
  } else {
    all.of[gpu_memory] = {way.gpu_memory_mib, here.gpus[choice.gpu]};
  }
  return all;
}

occupancy::saved occupancy::place(const deployment& way,
                                  const candidate& choice) {
  auto& here = rooms_[choice.node];
  saved before{here.cpu, here.memory,   here.disk,
               0,        here.cpu_used, here.memory_used};
  here.cpu -= way.cpu;
  here.memory -= way.memory_mib;
  here.disk -= way.disk_mib;
  here.cpu_used += way.cpu;
  here.memory_used += way.memory_mib;
  if (choice.gpu >= 0) {
    before.gpu_memory = here.gpus[choice.gpu];
    if (asked_.nodes[choice.node].unified_memory)
      here.memory -= way.gpu_memory_mib;
    else
      here.gpus[choice.gpu] -= way.gpu_memory_mib;
  }
  if (here.steps++ == 0)
    used_nodes_.push_back(choice.node);
  return before;
}

void occupancy::restore(const candidate& choice, const saved& before) {
  auto& here = rooms_[choice.node];
  here.cpu = before.cpu;
  here.memory = before.memory;
  here.disk = before.disk;
  here.cpu_used = before.cpu_used;
  here.memory_used = before.memory_used;
  if (choice.gpu >= 0)
    here.gpus[choice.gpu] = before.gpu_memory;
  if (--here.steps == 0)
    used_nodes_.pop_back();
}

double occupancy::load(std::size_t node) const {
  const auto& host = asked_.nodes[node];
  return (rooms_[node].cpu_used / host.cpu.capacity
          + rooms_[node].memory_used / host.memory_mib.capacity)
         / 2;
}

double occupancy::load_rise(std::size_t node, double cores,
                            double mebibytes) const {
  const auto& host = asked_.nodes[node];
  const auto& here = rooms_[node];
  return (std::min(cores, here.cpu + tolerance) / host.cpu.capacity
          + std::min(mebibytes, here.memory + tolerance)
                / host.memory_mib.capacity)
         / 2;
}

double occupancy::load_variance() const {
  if (used_nodes_.empty())
    return 0;
  auto count = static_cast<double>(used_nodes_.size());
  double mean = 0;
  for (auto node : used_nodes_)
    mean += load(node);
  mean /= count;
  double sum = 0;
  for (auto node : used_nodes_)
    sum += (load(node) - mean) * (load(node) - mean);
  return sum / count;
}

} // namespace roscell::allocation
