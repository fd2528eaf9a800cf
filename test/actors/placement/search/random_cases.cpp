#include "random_cases.hpp"

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

namespace roscell::allocation::test {

namespace {

/// Bounds the size of the Cartesian product, and so the time of a case; one
/// case in ten may be large.
constexpr double most_allocations = 20'000;
constexpr double most_if_large = 200'000;

class generator {
public:
  explicit generator(std::uint32_t seed) : random_(seed) {
    // A few amounts make ties and exact fits common; many make them rare.
    grain_ = one_of({1.0, 0.5, 0.1, 0.001});
    tight_ = chance(0.3);
    picky_ = chance(0.3);
    most_ = chance(0.1) ? most_if_large : most_allocations;
  }

  oracle::instance run() {
    for (;;) {
      oracle::instance in;
      in.alpha = one_of({0.1, 0.1, 0.0, 1.0, 7.5});
      in.beta = one_of({-0.01, -0.01, 0.0, -0.4, 0.05});
      auto nodes = std::max(between(1, 6), between(1, 6));
      for (int v = 0; v < nodes; ++v)
        in.machines.push_back(v > 0 && chance(0.25) ? in.machines.back()
                                                    : make_machine());
      auto tasks = std::max(between(1, 6), between(1, 6));
      for (int i = 0; i < tasks; ++i)
        in.tasks.push_back(i > 0 && chance(0.2) ? in.tasks.back()
                                                : make_task(nodes));
      if (chance(0.4))
        put_together(in);
      double size = 1;
      for (int i = 0; i < tasks; ++i)
        size *= oracle::all_candidates(in, i);
      if (size <= most_)
        return in;
    }
  }

private:
  bool chance(double p) {
    return std::uniform_real_distribution<>(0, 1)(random_) < p;
  }
  int between(int low, int high) {
    return std::uniform_int_distribution<>(low, high)(random_);
  }
  double one_of(std::vector<double> values) {
    return values[static_cast<std::size_t>(
        between(0, static_cast<int>(values.size()) - 1))];
  }
  /// A multiple of the grain from 0 to `most`.
  double amount(double most) {
    return between(0, static_cast<int>(most / grain_)) * grain_;
  }

  oracle::capacity make_capacity(double least, double most) {
    oracle::capacity made;
    made.c = chance(0.02) ? 0 : least + amount(most - least);
    if (chance(0.5))
      made.u = amount(made.c / 2);
    if (chance(0.05))
      made.u = made.c; // full
    if (chance(0.03))
      made.u = made.c + 1; // above capacity
    return made;
  }

  oracle::machine make_machine() {
    double least = tight_ ? 2 : 4;
    double most = tight_ ? 4 : 12;
    oracle::machine made;
    made.arch = chance(0.7) ? "amd64" : "arm64";
    made.um = chance(0.3);
    made.cpu = make_capacity(least, most);
    made.mem = make_capacity(least, made.um ? 2 * most : most);
    made.disk = make_capacity(least, most);
    auto gpus = chance(0.5) ? between(1, 4) : 0;
    for (int g = 0; g < gpus; ++g)
      made.gmem.push_back(g > 0 && chance(0.5) ? made.gmem.back()
                                               : make_capacity(least, most));
    for (const char* tag : {"camera", "arm"})
      if (chance(0.6))
        made.tags.emplace_back(tag);
    return made;
  }

  double make_request() {
    return chance(0.15) ? 0 : amount(tight_ ? 2 : 3);
  }

  oracle::way preempt_instances() {
    oracle::way made;
    made.gpu = chance(0.4);
    made.cpu = make_request();
    made.mem = make_request();
    made.disk = make_request();
    made.gmem = made.gpu ? make_request() : 0;
    if (picky_ && chance(0.4))
      made.archs = {chance(0.5) ? "arm64" : "amd64"};
    if (picky_ && chance(0.3))
      made.tags = {chance(0.5) ? "camera" : "arm"};
    return made;
  }

  oracle::task make_task(int nodes) {
    oracle::task made;
    auto ways = between(1, 2);
    for (int d = 0; d < ways; ++d)
      made.ways.push_back(preempt_instances());
    for (int v = 0; v < nodes; ++v)
      made.skill.push_back(!picky_ || chance(0.85));
    return made;
  }

  /// Some of the tasks must share a machine, in one or two groups.
  void put_together(oracle::instance& in) {
    auto groups = between(1, 2);
    for (auto& task : in.tasks)
      task.together = chance(0.6) ? between(1, groups) : 0;
  }

  std::mt19937 random_;
  double grain_ = 1;
  bool tight_ = false;
  bool picky_ = false;
  double most_ = 0;
};

amount same(const oracle::capacity& of) {
  return {of.c, of.u};
}

node translated(const oracle::machine& from, std::size_t v) {
  node made;
  made.name = "node-" + std::to_string(v);
  made.architecture = from.arch;
  made.unified_memory = from.um;
  made.cpu = same(from.cpu);
  made.memory_mib = same(from.mem);
  made.disk_mib = same(from.disk);
  // Listed in reverse, since the tie rule goes by index and not by position.
  for (auto g = from.gmem.size(); g-- > 0;)
    made.gpus.push_back({static_cast<int>(g), same(from.gmem[g])});
  for (const auto& tag : from.tags)
    if (tag == "camera")
      made.devices.push_back(tag);
    else
      made.labels[tag] = "yes";
  return made;
}

deployment translated(const oracle::way& from, std::size_t d) {
  deployment made;
  made.name = "way-" + std::to_string(d);
  made.architectures = from.archs;
  made.cpu = from.cpu;
  made.memory_mib = from.mem;
  made.disk_mib = from.disk;
  made.needs_gpu = from.gpu;
  made.gpu_memory_mib = from.gmem;
  for (const auto& tag : from.tags)
    if (tag == "camera")
      made.devices.push_back(tag);
    else
      made.labels[tag] = "yes";
  return made;
}

} // namespace

oracle::instance random_instance(std::uint32_t seed) {
  return generator(seed).run();
}

problem translated(const oracle::instance& in) {
  problem made;
  made.alpha = in.alpha;
  made.gpu_bonus = in.beta;
  for (std::size_t v = 0; v < in.machines.size(); ++v)
    made.nodes.push_back(translated(in.machines[v], v));
  for (const auto& from : in.tasks) {
    step wanted;
    wanted.id = "step-" + std::to_string(made.steps.size());
    for (std::size_t d = 0; d < from.ways.size(); ++d)
      wanted.deployments.push_back(translated(from.ways[d], d));
    for (std::size_t v = 0; v < in.machines.size(); ++v)
      if (from.skill[v])
        wanted.nodes_with_skill.insert(made.nodes[v].name);
    wanted.together = static_cast<std::size_t>(from.together);
    made.steps.push_back(std::move(wanted));
  }
  return made;
}

std::vector<oracle::pick> picks(const result& answer) {
  std::vector<oracle::pick> all;
  for (const auto& one : answer.placements)
    all.push_back({static_cast<int>(one.node), static_cast<int>(one.deployment),
                   one.gpu});
  return all;
}

int case_count(int otherwise) {
  const char* given = std::getenv("ROSCELL_ALLOCATION_CASES");
  return given ? std::atoi(given) : otherwise;
}

} // namespace roscell::allocation::test
