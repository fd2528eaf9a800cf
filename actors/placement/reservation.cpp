#include "actors/placement/reservation.hpp"

#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/occupancy.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using allocation::resource;

double free_of(const amount& x) {
  return std::max(0.0, x.capacity - x.used);
}

const gpu_resources* find_gpu(const node_resources& node, int index) {
  const auto found =
      std::find_if(node.gpus.begin(), node.gpus.end(),
                   [&](const auto& x) { return x.index == index; });
  return found == node.gpus.end() ? nullptr : &*found;
}

} // namespace

double compressible_cpu(const amount& of_others, double floor) {
  if (floor <= 0)
    return 0;
  return std::max(0.0, of_others.used - of_others.capacity * (1 - floor));
}

void read_with_cpu_floor(node_resources& node) {
  node.cpu.used =
      std::max(0.0, node.cpu.used - std::exchange(node.cpu_compressible, 0));
}

namespace {

/// @param sign 1 or -1.
void add(node_resources& node, const resource_request& request, int gpu,
         double sign) {
  node.cpu.used += sign * request.cpu;
  node.memory_mib.used += sign * request.memory_mib;
  node.disk_mib.used += sign * request.disk_mib;
  if (!request.needs_gpu())
    return;
  if (node.unified_memory) {
    node.memory_mib.used += sign * request.gpu_memory_mib;
    return;
  }
  for (auto& x : node.gpus)
    if (x.index == gpu)
      x.memory_mib.used += sign * request.gpu_memory_mib;
}

} // namespace

void reserve(node_resources& node, const resource_request& request, int gpu) {
  add(node, request, gpu, 1);
}

void unreserve(node_resources& node, const resource_request& request, int gpu) {
  add(node, request, gpu, -1);
}

std::vector<std::string> shortages(const node_resources& node,
                                   const resource_request& request, int gpu) {
  std::vector<std::string> result;
  auto check = [&](resource kind, double needed, const amount& of) {
    if (needed > free_of(of) + allocation::tolerance)
      result.push_back(allocation::shortage_text(kind, needed, free_of(of)));
  };
  const bool pooled = request.needs_gpu() && node.unified_memory;
  check(resource::cpu, request.cpu, node.cpu);
  check(resource::memory,
        request.memory_mib + (pooled ? request.gpu_memory_mib : 0),
        node.memory_mib);
  check(resource::disk, request.disk_mib, node.disk_mib);
  if (!request.needs_gpu())
    return result;
  const auto* card = find_gpu(node, gpu);
  if (card == nullptr)
    result.push_back("the node has no GPU " + std::to_string(gpu));
  else if (!pooled)
    check(resource::gpu_memory, request.gpu_memory_mib, card->memory_mib);
  return result;
}

} // namespace roscell
