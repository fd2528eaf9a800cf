#include "actors/placement/search/report/use.hpp"

namespace roscell::allocation {

namespace {

/// What the placements take of one node.
class bill {
public:
  explicit bill(const node& host) : host_(host), gpus_(host.gpus.size()) {}

  void add(const deployment& way, int gpu) {
    ++steps_;
    cpu_ += way.cpu;
    memory_ += way.memory_mib;
    disk_ += way.disk_mib;
    if (host_.unified_memory)
      memory_ += way.gpu_memory_mib;
    else
      for (std::size_t i = 0; i < gpus_.size(); ++i)
        gpus_[i] += host_.gpus[i].index == gpu ? way.gpu_memory_mib : 0;
  }

  void write(std::size_t node, std::vector<use>& to) const {
    if (steps_ == 0)
      return;
    auto line = [&](const std::string& name, const amount& of, double more) {
      to.push_back({node, name, of.capacity, of.used, of.used + more});
    };
    line("cpu", host_.cpu, cpu_);
    line("memory", host_.memory_mib, memory_);
    line("disk", host_.disk_mib, disk_);
    if (!host_.unified_memory)
      for (std::size_t i = 0; i < gpus_.size(); ++i)
        line("gpu_" + std::to_string(host_.gpus[i].index),
             host_.gpus[i].memory_mib, gpus_[i]);
  }

private:
  const node& host_;
  std::size_t steps_ = 0;
  double cpu_ = 0;
  double memory_ = 0;
  double disk_ = 0;
  std::vector<double> gpus_;
};

} // namespace

std::vector<use> uses(const problem& asked,
                      const std::vector<placement>& placements) {
  std::vector<bill> bills;
  bills.reserve(asked.nodes.size());
  for (const auto& host : asked.nodes)
    bills.emplace_back(host);
  for (const auto& one : placements)
    bills[one.node].add(asked.steps[one.step].deployments[one.deployment],
                        one.gpu);
  std::vector<use> all;
  for (std::size_t v = 0; v < bills.size(); ++v)
    bills[v].write(v, all);
  return all;
}

} // namespace roscell::allocation
