#pragma once

#include "messages/codec/described.hpp"

#include <map>
#include <string>
#include <vector>

namespace roscell {

/// What there is of one resource and how much of it is taken. CPU is counted
/// in cores; memory, disk and GPU memory in MiB (design: allocation).
struct amount {
  double capacity = 0;
  double used = 0;

  static constexpr auto fields() {
    return field_list{required("capacity", &amount::capacity),
                      required("used", &amount::used)};
  }
};

struct gpu_resources {
  int index = 0;
  std::string name;
  amount memory_mib; ///< Zero on a unified-memory node: the pool is the node's.

  static constexpr auto fields() {
    return field_list{required("index", &gpu_resources::index),
                      optional("name", &gpu_resources::name),
                      optional("memory_mib", &gpu_resources::memory_mib)};
  }
};

/// What a node offers and what of it is in use.
/// JSON form: `node_resources` in schemas/common.schema.json.
struct node_resources {
  std::string name;
  std::string architecture; ///< As container images name it: amd64, arm64.
  bool unified_memory = false;
  amount cpu;
  amount memory_mib;
  amount disk_mib;
  std::vector<gpu_resources> gpus;
  std::map<std::string, std::string> labels;
  std::vector<std::string> devices; ///< Absolute paths below /dev.
  /// Cores of `cpu.used` that programs outside our instances would share with
  /// a new process. 0 where nothing may be counted on.
  double cpu_compressible = 0;
  /// What its configuration grants to skills, "SKILL=WHAT" each.
  std::vector<std::string> grants;
  std::vector<std::string> secrets; ///< Names of those that it keeps.

  static constexpr auto fields() {
    return field_list{
        required("name", &node_resources::name),
        required("architecture", &node_resources::architecture),
        required("unified_memory", &node_resources::unified_memory),
        required("cpu", &node_resources::cpu),
        required("memory_mib", &node_resources::memory_mib),
        required("disk_mib", &node_resources::disk_mib),
        required("gpus", &node_resources::gpus),
        required("labels", &node_resources::labels),
        required("devices", &node_resources::devices),
        optional("cpu_compressible", &node_resources::cpu_compressible),
        optional("grants", &node_resources::grants),
        optional("secrets", &node_resources::secrets)};
  }
};

/// What one deployment option asks for.
struct resource_request {
  double cpu = 0;
  double memory_mib = 0;
  double disk_mib = 0;
  double gpu_memory_mib = -1; ///< Negative: the deployment needs no GPU.

  bool needs_gpu() const {
    return gpu_memory_mib >= 0;
  }

  static constexpr auto fields() {
    return field_list{
        required("cpu", &resource_request::cpu),
        required("memory_mib", &resource_request::memory_mib),
        required("disk_mib", &resource_request::disk_mib),
        optional("gpu_memory_mib", &resource_request::gpu_memory_mib)};
  }
};

} // namespace roscell
