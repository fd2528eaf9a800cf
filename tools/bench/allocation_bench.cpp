#include "actors/placement/search/allocation.hpp"
#include "actors/placement/search/assignment.hpp"
#include "tools/bench/allocation_cells.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <optional>
#include <vector>

/// Times the allocation search on random cells, one JSON line per size and
/// kind of cell, beside plain enumeration wherever that is short enough.
namespace {

namespace alloc = roscell::allocation;
using namespace roscell::bench;

struct bench_options {
  std::vector<int> steps{1, 2, 4, 6, 8, 10, 12, 14, 16, 20};
  std::vector<int> nodes{1, 3, 10, 30, 100, 300, 1000};
  int cases = 10;
  int budget_ms = 200;
  unsigned seed = 1;
  double most_enumerated = 1e6;
};

/// CPU time of this thread, so that what else the machine does counts little.
std::chrono::steady_clock::time_point cpu_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::chrono::steady_clock::time_point{
      std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec)};
}

double cpu_ms() {
  return std::chrono::duration<double, std::milli>(cpu_now().time_since_epoch())
      .count();
}

/// The CPU clock costs a system call, so it is read once in a while only.
auto seldom_read_clock() {
  constexpr unsigned every = 64;
  return [calls = 0U, last = cpu_now()]() mutable {
    if (++calls % every == 0)
      last = cpu_now();
    return last;
  };
}

/// What was measured in the cases of one shape.
struct metrics {
  std::vector<double> cpu_ms, wall_ms, branches, gap, enumeration_ms;
  int feasible = 0;
  int solved = 0;
  int differing = 0; ///< Cases where enumeration found another total.
};

double quantile(std::vector<double> values, double share) {
  if (values.empty())
    return 0;
  std::sort(values.begin(), values.end());
  auto last = static_cast<double>(values.size()) - 1;
  return values[static_cast<std::size_t>(std::ceil(share * last))];
}

/// Every allocation there is, one after the other, as the paper does it.
class enumeration {
public:
  explicit enumeration(const alloc::problem& asked)
      : candidates_(alloc::find_candidates(asked, rejected_)),
        empty_(asked), space_{asked, candidates_, empty_} {}

  double size() const {
    double product = 1;
    for (const auto& list : candidates_.of)
      product *= static_cast<double>(list.size());
    return product;
  }

  std::optional<double> best() {
    auto scratch = empty_;
    std::optional<double> least;
    alloc::assignment tried(space_.steps());
    do {
      auto value = evaluate(space_, tried, scratch);
      if (value && (!least || value->total < *least))
        least = value->total;
    } while (advance(tried));
    return least;
  }

private:
  bool advance(alloc::assignment& tried) const {
    for (std::size_t i = 0; i < tried.size(); ++i) {
      if (++tried[i] < candidates_.of[i].size())
        return true;
      tried[i] = 0;
    }
    return false;
  }

  std::vector<alloc::rejected_candidate> rejected_;
  alloc::candidate_set candidates_;
  alloc::occupancy empty_;
  alloc::search_space space_;
};

void enumerate(const alloc::problem& asked, const alloc::result& answer,
               double most, metrics& into) {
  enumeration all(asked);
  if (all.size() < 1 || all.size() > most)
    return;
  auto before = cpu_ms();
  auto best = all.best();
  into.enumeration_ms.push_back(cpu_ms() - before);
  if (best.has_value() != answer.has_allocation()
      || (best && std::abs(*best - answer.value.total) > 1e-12))
    ++into.differing;
}

void measure_one(const cell_shape& shape, unsigned seed,
                 const bench_options& options, metrics& into) {
  auto asked = make_problem(shape, seed);
  alloc::limits bounds;
  bounds.budget = std::chrono::milliseconds(options.budget_ms);
  bounds.now = seldom_read_clock();
  auto wall = std::chrono::steady_clock::now();
  auto cpu = cpu_ms();
  auto answer = alloc::allocate(asked, bounds);
  into.cpu_ms.push_back(cpu_ms() - cpu);
  into.wall_ms.push_back(std::chrono::duration<double, std::milli>(
                             std::chrono::steady_clock::now() - wall)
                             .count());
  into.branches.push_back(static_cast<double>(answer.expanded));
  into.feasible += answer.has_allocation() ? 1 : 0;
  if (answer.optimal() || answer.what == alloc::outcome::infeasible)
    ++into.solved;
  if (answer.has_allocation())
    into.gap.push_back(answer.value.total - answer.lower_bound);
  if (answer.optimal())
    enumerate(asked, answer, options.most_enumerated, into);
}

void print(const cell_shape& shape, const metrics& of) {
  const auto cases = static_cast<double>(of.cpu_ms.size());
  nlohmann::json line{{"bench", "allocation"},
                      {"kind", to_string(shape.kind)},
                      {"tight", shape.tight},
                      {"gpus", shape.gpus},
                      {"steps", shape.steps},
                      {"nodes", shape.nodes},
                      {"cases", of.cpu_ms.size()},
                      {"feasible", of.feasible / cases},
                      {"solved", of.solved / cases},
                      {"median_ms", quantile(of.cpu_ms, 0.5)},
                      {"p99_ms", quantile(of.cpu_ms, 0.99)},
                      {"p99_wall_ms", quantile(of.wall_ms, 0.99)},
                      {"median_branches", quantile(of.branches, 0.5)},
                      {"worst_gap", quantile(of.gap, 1)}};
  if (!of.enumeration_ms.empty())
    line.update({{"enumerated", of.enumeration_ms.size()},
                 {"enumeration_median_ms", quantile(of.enumeration_ms, 0.5)},
                 {"differing", of.differing}});
  std::cout << line << std::endl;
}

void measure(const cell_shape& shape, const bench_options& options) {
  metrics found;
  for (int i = 0; i < options.cases; ++i)
    measure_one(shape, options.seed + static_cast<unsigned>(i), options, found);
  print(shape, found);
}

void measure_all(const bench_options& options) {
  for (auto kind :
       {variety::homogeneous, variety::few_kinds, variety::all_different})
    for (bool tight : {false, true})
      for (bool gpus : {false, true})
        for (int steps : options.steps)
          for (int nodes : options.nodes)
            measure({steps, nodes, kind, tight, gpus}, options);
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app{"Times the allocation search on random cells."};
  bench_options options;
  app.add_option("--steps", options.steps, "Numbers of steps")->delimiter(',');
  app.add_option("--nodes", options.nodes, "Numbers of nodes")->delimiter(',');
  app.add_option("--cases", options.cases, "Random cases of each shape");
  app.add_option("--budget", options.budget_ms, "Budget of a search in ms");
  app.add_option("--seed", options.seed, "Seed of the first case");
  app.add_option("--enumerate", options.most_enumerated,
                 "Allocations that are still enumerated");
  CLI11_PARSE(app, argc, argv);
  measure_all(options);
}
