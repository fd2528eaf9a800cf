#include "actors/reservation.hpp"

namespace roscell {

void reserve(node_resources& node, const resource_request& request, int gpu) {
  node.cpu.used += request.cpu;
  node.memory_mib.used += request.memory_mib;
  node.disk_mib.used += request.disk_mib;
  if (!request.needs_gpu())
    return;
  if (node.unified_memory) {
    node.memory_mib.used += request.gpu_memory_mib;
    return;
  }
  for (auto& x : node.gpus)
    if (x.index == gpu)
      x.memory_mib.used += request.gpu_memory_mib;
}

} // namespace roscell
