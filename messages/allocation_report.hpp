#pragma once

#include "messages/skill.hpp"
#include "messages/task.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What the scheduler decided and why.
namespace roscell {

/// Paper, equation (1): total = balance + alpha * load.
struct allocation_score {
  double total = 0;
  double balance = 0;
  double load = 0;
  double alpha = 0.1;
  double lower_bound = 0; ///< No allocation has a lower total.
  double gap = 0;         ///< How far the total is above it; 0 when optimal.

  static constexpr auto fields() {
    return field_list{required("total", &allocation_score::total),
                      required("balance", &allocation_score::balance),
                      required("load", &allocation_score::load),
                      required("alpha", &allocation_score::alpha),
                      required("lower_bound", &allocation_score::lower_bound),
                      required("gap", &allocation_score::gap)};
  }
};

/// Paper, equation (4), per resource of R_i.
struct resource_fractions {
  double cpu = 0;
  double memory = 0;
  double disk = 0;
  double gpu_memory = -1; ///< Negative: not in R_i.

  static constexpr auto fields() {
    return field_list{required("cpu", &resource_fractions::cpu),
                      required("memory", &resource_fractions::memory),
                      required("disk", &resource_fractions::disk),
                      optional("gpu_memory", &resource_fractions::gpu_memory)};
  }
};

struct step_allocation {
  std::string step;
  std::string node;
  std::string deployment;
  int gpu = -1; ///< Negative: none.
  resource_fractions fractions;
  double variance = 0;
  double bonus = 0;
  std::string build; ///< Hash of the skill's build; empty on paper.
  /// What the node has to fetch before it can start the step.
  double fetch_mib = 0;

  static constexpr auto fields() {
    return field_list{required("step", &step_allocation::step),
                      required("node", &step_allocation::node),
                      required("deployment", &step_allocation::deployment),
                      nullable("gpu", &step_allocation::gpu),
                      required("fractions", &step_allocation::fractions),
                      required("variance", &step_allocation::variance),
                      required("bonus", &step_allocation::bonus),
                      optional("build", &step_allocation::build),
                      optional("fetch_mib", &step_allocation::fetch_mib)};
  }
};

/// One of the reasons against a candidate, for programs. The numbers are cores
/// or MiB; negative where no amount is short, as of a label.
struct rejection_cause {
  std::string kind; ///< As `allocation::reason_kind` spells it.
  double needed = -1;
  double free = -1;
  double short_by = -1;

  static constexpr auto fields() {
    return field_list{required("kind", &rejection_cause::kind),
                      optional("needed", &rejection_cause::needed),
                      optional("free", &rejection_cause::free),
                      optional("short_by", &rejection_cause::short_by)};
  }
};

struct rejected_candidate {
  std::string step;
  std::string node;
  std::string deployment;
  std::vector<std::string> reasons;
  std::vector<rejection_cause> causes; ///< One for each of the reasons.
  int gpu = -1;                        ///< Negative: none.

  static constexpr auto fields() {
    return field_list{required("step", &rejected_candidate::step),
                      required("node", &rejected_candidate::node),
                      required("deployment", &rejected_candidate::deployment),
                      required("reasons", &rejected_candidate::reasons),
                      optional("causes", &rejected_candidate::causes),
                      optional("gpu", &rejected_candidate::gpu)};
  }
};

/// A candidate that a search must leave out, such as one that its node refused.
struct excluded_candidate {
  std::string step;
  std::string node;
  std::string deployment;
  int gpu = -1; ///< Negative: none.
  std::string reason;
  /// How the CPU was read when the node refused it.
  bool cpu_floor = false;

  static constexpr auto fields() {
    return field_list{required("step", &excluded_candidate::step),
                      required("node", &excluded_candidate::node),
                      required("deployment", &excluded_candidate::deployment),
                      nullable("gpu", &excluded_candidate::gpu),
                      required("reason", &excluded_candidate::reason),
                      optional("cpu_floor", &excluded_candidate::cpu_floor)};
  }
};

/// One resource of a node that hosts steps, before and after them. CPU is in
/// cores, the others in MiB.
struct resource_use {
  std::string node;
  std::string resource; ///< cpu, memory, disk, or gpu with its index: gpu_0.
  double capacity = 0;
  double before = 0;
  double after = 0;

  static constexpr auto fields() {
    return field_list{required("node", &resource_use::node),
                      required("resource", &resource_use::resource),
                      required("capacity", &resource_use::capacity),
                      required("before", &resource_use::before),
                      required("after", &resource_use::after)};
  }
};

/// The best allocation in which one step is placed otherwise.
struct step_alternative {
  std::string step;
  bool optimal = true;  ///< No other alternative is better.
  double extra = 0;     ///< What its total is above that of the plan.
  std::string obstacle; ///< Why there is none; empty if there is one.
  allocation_score score;
  std::vector<step_allocation> allocations;

  static constexpr auto fields() {
    return field_list{required("step", &step_alternative::step),
                      required("optimal", &step_alternative::optimal),
                      required("extra", &step_alternative::extra),
                      optional("obstacle", &step_alternative::obstacle),
                      required("score", &step_alternative::score),
                      required("allocations", &step_alternative::allocations)};
  }
};

struct task_plan {
  static constexpr const char* type = "task_plan";
  std::string task;
  bool optimal = true;
  allocation_score score;
  std::vector<step_allocation> allocations;
  std::vector<rejected_candidate> rejected;
  std::vector<std::string> warnings;
  int64_t states = 0; ///< Explored by the search.
  std::vector<resource_use> use;
  std::vector<step_alternative> alternatives; ///< Of the step asked about.
  /// A strict reading of the CPU has no allocation: what other programs use
  /// was counted up to each node's floor.
  bool cpu_floor = false;
  /// What has to go before it fits: the fewest, of these the lowest.
  std::vector<preempted_instance> preempted;

  static constexpr auto fields() {
    return field_list{required("task", &task_plan::task),
                      required("optimal", &task_plan::optimal),
                      required("score", &task_plan::score),
                      required("allocations", &task_plan::allocations),
                      required("rejected", &task_plan::rejected),
                      optional("warnings", &task_plan::warnings),
                      optional("states", &task_plan::states),
                      optional("use", &task_plan::use),
                      optional("alternatives", &task_plan::alternatives),
                      optional("cpu_floor", &task_plan::cpu_floor),
                      optional("preempted", &task_plan::preempted)};
  }
};

/// How a task request has found its task.
enum class task_found {
  started,  ///< There was none: the request has started it.
  anew,     ///< It had ended: the request has started its next run.
  running,  ///< All of it runs.
  degraded, ///< Not all of it does, and `waits` says why.
  finished, ///< It has ended, with 0,
  failed,   ///< or not; and the request is not one for another run.
};

constexpr auto enum_words(task_found) {
  return std::array<std::string_view, 6>{"started",  "anew",     "running",
                                         "degraded", "finished", "failed"};
}

/// A step that does not run yet.
struct awaited_step {
  std::string step;
  std::string instance;
  std::string node;
  std::string reason; ///< What it waits for, one sentence.

  static constexpr auto fields() {
    return field_list{required("step", &awaited_step::step),
                      required("instance", &awaited_step::instance),
                      required("node", &awaited_step::node),
                      required("reason", &awaited_step::reason)};
  }
};

/// Reply to `task_request`: how things stand once they have been put right as
/// far as that can be done at once.
struct task_accepted {
  static constexpr const char* type = "task_accepted";
  std::string task;
  bool optimal = true;
  allocation_score score;
  std::vector<step_allocation> allocations;
  std::vector<placed_instance> instances;
  /// What nodes refused before this allocation was found.
  std::vector<excluded_candidate> refused;
  std::vector<std::string> warnings; ///< What may not be meant so.
  /// Steps that had ended and were started again by this request.
  std::vector<std::string> healed;
  std::vector<preempted_instance> preempted; ///< What it has preempted.
  task_found found = task_found::started;
  std::vector<awaited_step> waits; ///< Of a task that is `degraded`.
  int64_t run = 1; ///< How often it has been started as a whole.

  static constexpr auto fields() {
    return field_list{required("task", &task_accepted::task),
                      required("optimal", &task_accepted::optimal),
                      required("score", &task_accepted::score),
                      required("allocations", &task_accepted::allocations),
                      required("instances", &task_accepted::instances),
                      optional("refused", &task_accepted::refused),
                      optional("warnings", &task_accepted::warnings),
                      optional("healed", &task_accepted::healed),
                      optional("preempted", &task_accepted::preempted),
                      optional("found", &task_accepted::found),
                      optional("waits", &task_accepted::waits),
                      optional("run", &task_accepted::run)};
  }
};

/// The document of `roscell plan FILE`: a cell on paper and a request to it.
struct plan_document {
  std::vector<node_resources> nodes;
  std::vector<skill_descriptor> skills; ///< Every node has all of them.
  task_request request;

  static constexpr auto fields() {
    return field_list{required("nodes", &plan_document::nodes),
                      required("skills", &plan_document::skills),
                      required("request", &plan_document::request)};
  }
};

} // namespace roscell
