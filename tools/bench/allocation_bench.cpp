#include "actors/allocation/allocation.hpp"

#include <chrono>
#include <iomanip>
#include <iostream>
#include <random>
#include <string>

/// Times the allocation search on random cells of different nodes, with and
/// without GPU deployments, one JSON line per figure: `allocation_bench
/// [BUDGET_MS]`. A case that the budget ends says how far its bound is from the
/// best that was found.
namespace {

namespace alloc = roscell::allocation;

class generator {
public:
  generator(unsigned seed, bool gpus) : random_(seed), gpus_(gpus) {}

  alloc::problem run(int steps, int nodes) {
    alloc::problem made;
    for (int v = 0; v < nodes; ++v)
      made.nodes.push_back(make_node(v));
    for (int i = 0; i < steps; ++i)
      made.steps.push_back(make_step(made, i));
    return made;
  }

private:
  double between(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }

  alloc::amount make_amount(double capacity) {
    return {capacity, capacity * between(0.02, 0.6)};
  }

  /// From a small board to a server; a third have GPUs, half of these share
  /// their memory with them.
  alloc::node make_node(int v) {
    auto size = static_cast<double>(1 << static_cast<int>(between(1, 6)));
    alloc::node made;
    made.name = "node-" + std::to_string(v);
    made.architecture = between(0, 1) < 0.5 ? "amd64" : "arm64";
    made.cpu = make_amount(size);
    made.memory_mib = make_amount(size * 1024 * between(1, 4));
    made.disk_mib = make_amount(size * 8192 * between(1, 4));
    if (between(0, 1) < 0.33) {
      made.unified_memory = between(0, 1) < 0.5;
      made.gpus.push_back({0, make_amount(8192)});
    }
    return made;
  }

  alloc::step make_step(const alloc::problem& in, int i) {
    alloc::step made;
    made.id = "step-" + std::to_string(i);
    for (const auto& node : in.nodes)
      made.nodes_with_skill.insert(node.name);
    alloc::deployment way;
    way.name = "cpu";
    way.cpu = between(0.1, 2);
    way.memory_mib = between(64, 2048);
    way.disk_mib = between(100, 4096);
    made.deployments.push_back(way);
    if (!gpus_)
      return made;
    way.name = "gpu";
    way.needs_gpu = true;
    way.cpu /= 2;
    way.gpu_memory_mib = between(256, 4096);
    made.deployments.push_back(way);
    return made;
  }

  std::mt19937 random_;
  bool gpus_;
};

void measure(int steps, int nodes, bool gpus, unsigned seed, int budget_ms) {
  auto asked = generator(seed, gpus).run(steps, nodes);
  alloc::limits bounds;
  bounds.budget = std::chrono::milliseconds(budget_ms);
  auto start = std::chrono::steady_clock::now();
  auto answer = alloc::allocate(asked, bounds);
  std::chrono::duration<double, std::milli> took =
      std::chrono::steady_clock::now() - start;
  std::cout << std::setprecision(6) << "{\"bench\":\"allocation\",\"gpus\":"
            << (gpus ? "true" : "false") << ",\"steps\":" << steps
            << ",\"nodes\":" << nodes << ",\"seed\":" << seed
            << ",\"ms\":" << took.count()
            << ",\"feasible\":" << (answer.has_allocation() ? "true" : "false")
            << ",\"optimal\":" << (answer.optimal() ? "true" : "false")
            << ",\"total\":" << answer.value.total << ",\"gap\":"
            << (answer.has_allocation()
                    ? answer.value.total - answer.lower_bound
                    : 0)
            << ",\"branches\":" << answer.expanded << "}" << std::endl;
}

} // namespace

int main(int argc, char** argv) {
  auto budget_ms = argc > 1 ? std::stoi(argv[1]) : 2000;
  for (int steps : {2, 4, 6, 8, 10})
    for (int nodes : {5, 10, 20, 50, 100})
      for (bool gpus : {false, true})
        for (unsigned seed : {1U, 2U, 3U})
          measure(steps, nodes, gpus, seed, budget_ms);
}
