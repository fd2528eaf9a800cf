#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// What an allocation is asked about: plain values, no actors and no JSON.
/// docs/allocation.md gives the objective, the method and the tie rule.
namespace roscell::allocation {

/// The cost of what cannot be had.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a resource offers and how much of it is taken. CPU is in cores, all
/// memory and disk in MiB. `used` may exceed `capacity`, which counts as full.
struct amount {
  double capacity = 0;
  double used = 0;
};

/// One GPU of a node. On a unified-memory node its memory is not read: there
/// the pool is the node's memory.
struct gpu {
  int index = 0;
  amount memory_mib;
};

using label_map = std::map<std::string, std::string>;

struct node {
  std::string name;
  std::string architecture;
  bool unified_memory = false;
  amount cpu;
  amount memory_mib;
  amount disk_mib;
  std::vector<gpu> gpus;
  label_map labels;
  std::vector<std::string> devices;
  /// Cores in use that their users would share with a new process. Part of
  /// `cpu.used`; only `allocate_with_floor` reads it.
  double cpu_compressible = 0;
  std::vector<std::string> secrets; ///< Names of those that it has.
};

/// One deployment option of a step's implementation model.
struct deployment {
  std::string name;
  /// The architectures it runs on; empty means any.
  std::vector<std::string> architectures;
  double cpu = 0;
  double memory_mib = 0;
  double disk_mib = 0;
  bool needs_gpu = false;
  /// 0 unless `needs_gpu`.
  double gpu_memory_mib = 0;
  /// Devices and labels which the node must have.
  std::vector<std::string> devices;
  label_map labels;
  /// Names of the nodes that can run the step in this way; empty: all that have
  /// the skill. On others that have it, this is no candidate and needs no
  /// reason: they have another way.
  std::set<std::string> only_on;
};

/// One step of the request. The deployments are those of its model, narrowed
/// to one where the user names a preference.
struct step {
  std::string id;
  std::vector<deployment> deployments;
  /// Labels which the node must have, whatever the deployment.
  label_map labels;
  /// Names of the nodes that have the skill. Names of other nodes are ignored.
  std::set<std::string> nodes_with_skill;
  /// Steps with the same number, unless it is 0, must share a node.
  std::size_t together = 0;
  /// Names of secrets that the node must have, whatever the deployment.
  std::set<std::string> secrets;
};

/// A candidate that may not be taken. `node` and `deployment` are positions in
/// the problem, `gpu` is the index the node gives its GPU, or -1.
struct exclusion {
  std::size_t step = 0;
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
  /// A sentence for people.
  std::string reason;
  /// How the CPU was read when the node refused it. A strict refusal says
  /// nothing about the floored reading.
  bool cpu_floor = false;
};

struct problem {
  std::vector<node> nodes;
  /// In the order of the request, which the fractions depend on.
  std::vector<step> steps;
  /// Those of other candidates have no effect.
  std::vector<exclusion> excluded;
  /// Weight of the load term of equation (1).
  double alpha = 0.1;
  /// The paper's beta, added for each step that runs on a GPU.
  double gpu_bonus = -0.01;
};

/// When to give up the proof and answer with the best that was found.
struct limits {
  /// Time for the search; 0 means no limit.
  std::chrono::milliseconds budget{0};
  /// Asked before each branch of the search; true ends it. May be empty.
  std::function<bool()> cancelled;
  /// The clock the budget is measured with, so that tests need not wait.
  std::function<std::chrono::steady_clock::time_point()> now =
      std::chrono::steady_clock::now;
};

/// The fractions of equation (4): what a step takes of what is free for it.
struct fractions {
  double cpu = 0;
  double memory = 0;
  double disk = 0;
  /// Only where the deployment needs a GPU.
  std::optional<double> gpu_memory;
};

/// Where one step goes, and what that costs. `node` and `deployment` are
/// positions in the problem, `gpu` is the index the node gives its GPU, or -1.
struct placement {
  std::size_t step = 0;
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
  fractions shares;
  double variance = 0;
  double bonus = 0;
};

/// The objective of equation (1): total = balance + alpha * load.
struct score {
  double total = 0;
  double balance = 0;
  double load = 0;
};

enum class reason_kind {
  skill,        ///< The node does not have the skill.
  architecture, ///< The deployment does not run on the node's architecture.
  label,        ///< The node lacks a label.
  device,       ///< The node lacks a device.
  secret,       ///< The node lacks a secret.
  gpu,          ///< The node has no GPU.
  cpu,          ///< Too few cores are free.
  memory,       ///< Too little memory is free.
  disk,         ///< Too little disk is free.
  gpu_memory,   ///< Too little memory is free on the GPU.
  combination,  ///< It fits alone, but the steps do not fit together.
  excluded,     ///< The problem says that it may not be taken.
};

/// The word for a kind of reason, as it is spelled above.
const char* to_string(reason_kind kind);

/// Why a candidate is not taken. The numbers are 0 where none is short; they
/// are in cores or MiB like the resource that `text` names.
struct reason {
  reason_kind kind = reason_kind::skill;
  double needed = 0;
  double free = 0;
  double short_by = 0;
  std::string text;
};

/// A candidate that cannot be used, with every reason against it. `gpu` is -1
/// for a deployment without a GPU and for a node that has none.
struct rejected_candidate {
  std::size_t step = 0;
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
  std::vector<reason> reasons;
};

enum class outcome {
  optimal,    ///< The allocation that the tie rule picks among the minima.
  best_found, ///< Stopped early: a valid allocation, and a proven bound.
  infeasible, ///< Proven: no allocation of all steps exists.
  undecided,  ///< Stopped early, before any allocation was found.
  invalid,    ///< The problem was refused; `message` names the place.
};

struct result {
  outcome what = outcome::invalid;
  /// One per step, in their order; empty unless `has_allocation()`.
  std::vector<placement> placements;
  score value;
  /// No allocation has a total below this. Equal to the total when optimal,
  /// infinite when infeasible.
  double lower_bound = -std::numeric_limits<double>::infinity();
  /// Candidates that cannot be used even alone, in the order of steps, nodes,
  /// deployments and GPU indices. When infeasible, all other candidates follow
  /// in the same order, so that each one is explained.
  std::vector<rejected_candidate> rejected;
  /// When infeasible: steps that cannot be placed together, the fewest found.
  std::vector<std::size_t> conflict;
  std::vector<std::string> warnings;
  /// A sentence for people; empty when there is an optimal allocation.
  std::string message;
  /// Branches looked at, for measurements.
  std::size_t expanded = 0;

  bool optimal() const {
    return what == outcome::optimal;
  }
  bool has_allocation() const {
    return what == outcome::optimal || what == outcome::best_found;
  }
};

} // namespace roscell::allocation
