#include "tools/bench/allocation_cells.hpp"

namespace roscell::bench {

namespace {

constexpr int kinds_if_few = 4;

class generator {
public:
  generator(const cell_shape& shape, unsigned seed)
      : shape_(shape), random_(seed) {}

  allocation::problem run() {
    allocation::problem made;
    for (int v = 0; v < shape_.nodes; ++v)
      made.nodes.push_back(
          v < differing() ? make_node()
                          : made.nodes[static_cast<size_t>(v % differing())]);
    for (int v = 0; v < shape_.nodes; ++v)
      made.nodes[static_cast<size_t>(v)].name = "node-" + std::to_string(v);
    for (int i = 0; i < shape_.steps; ++i)
      made.steps.push_back(make_step(made, i));
    return made;
  }

private:
  int differing() const {
    switch (shape_.kind) {
    case variety::homogeneous:
      return 1;
    case variety::few_kinds:
      return kinds_if_few;
    default:
      return shape_.nodes;
    }
  }

  double between(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }

  allocation::amount make_amount(double capacity) {
    return {capacity,
            capacity * (shape_.tight ? between(0.4, 0.9) : between(0.02, 0.6))};
  }

  /// From a small board to a server; half of the GPUs are on unified memory.
  allocation::node make_node() {
    auto size = static_cast<double>(1 << static_cast<int>(between(1, 6)));
    allocation::node made;
    made.architecture = between(0, 1) < 0.5 ? "amd64" : "arm64";
    made.cpu = make_amount(size);
    made.memory_mib = make_amount(size * 1024 * between(1, 4));
    made.disk_mib = make_amount(size * 8192 * between(1, 4));
    if (shape_.gpus && between(0, 1) < 0.33) {
      made.unified_memory = between(0, 1) < 0.5;
      made.gpus.push_back({0, make_amount(8192)});
    }
    return made;
  }

  allocation::step make_step(const allocation::problem& in, int i) {
    allocation::step made;
    made.id = "step-" + std::to_string(i);
    for (const auto& node : in.nodes)
      made.nodes_with_skill.insert(node.name);
    allocation::deployment way;
    way.name = "cpu";
    way.cpu = between(0.1, shape_.tight ? 3 : 2);
    way.memory_mib = between(64, shape_.tight ? 4096 : 2048);
    way.disk_mib = between(100, 4096);
    made.deployments.push_back(way);
    if (!shape_.gpus)
      return made;
    way.name = "gpu";
    way.needs_gpu = true;
    way.cpu /= 2;
    way.gpu_memory_mib = between(256, 4096);
    made.deployments.push_back(way);
    return made;
  }

  cell_shape shape_;
  std::mt19937 random_;
};

} // namespace

const char* to_string(variety kind) {
  constexpr const char* words[] = {"homogeneous", "few_kinds", "all_different"};
  return words[static_cast<int>(kind)];
}

allocation::problem make_problem(const cell_shape& shape, unsigned seed) {
  return generator(shape, seed).run();
}

} // namespace roscell::bench
