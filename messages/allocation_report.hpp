#pragma once

#include "messages/skill_descriptor.hpp"
#include "messages/task.hpp"

#include <string>
#include <vector>

/// What the scheduler decided and why.
namespace roscell {

/// Paper, equation (1): total = balance + alpha * load.
struct allocation_score {
  double total = 0;
  double balance = 0;
  double load = 0;

  static constexpr auto fields() {
    return std::make_tuple(required("total", &allocation_score::total),
                           required("balance", &allocation_score::balance),
                           required("load", &allocation_score::load));
  }
};

/// Paper, equation (4), per resource of R_i.
struct resource_fractions {
  double cpu = 0;
  double memory = 0;
  double disk = 0;
  double gpu_memory = -1; ///< Negative: not in R_i.

  static constexpr auto fields() {
    return std::make_tuple(
        required("cpu", &resource_fractions::cpu),
        required("memory", &resource_fractions::memory),
        required("disk", &resource_fractions::disk),
        optional("gpu_memory", &resource_fractions::gpu_memory));
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

  static constexpr auto fields() {
    return std::make_tuple(required("step", &step_allocation::step),
                           required("node", &step_allocation::node),
                           required("deployment", &step_allocation::deployment),
                           nullable("gpu", &step_allocation::gpu),
                           required("fractions", &step_allocation::fractions),
                           required("variance", &step_allocation::variance),
                           required("bonus", &step_allocation::bonus));
  }
};

struct rejected_candidate {
  std::string step;
  std::string node;
  std::string deployment;
  std::vector<std::string> reasons;

  static constexpr auto fields() {
    return std::make_tuple(
        required("step", &rejected_candidate::step),
        required("node", &rejected_candidate::node),
        required("deployment", &rejected_candidate::deployment),
        required("reasons", &rejected_candidate::reasons));
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

  static constexpr auto fields() {
    return std::make_tuple(required("task", &task_plan::task),
                           required("optimal", &task_plan::optimal),
                           required("score", &task_plan::score),
                           required("allocations", &task_plan::allocations),
                           required("rejected", &task_plan::rejected),
                           optional("warnings", &task_plan::warnings));
  }
};

/// Reply to `task_request`: every step runs.
struct task_accepted {
  static constexpr const char* type = "task_accepted";
  std::string task;
  bool optimal = true;
  allocation_score score;
  std::vector<step_allocation> allocations;
  std::vector<placed_instance> instances;

  static constexpr auto fields() {
    return std::make_tuple(required("task", &task_accepted::task),
                           required("optimal", &task_accepted::optimal),
                           required("score", &task_accepted::score),
                           required("allocations", &task_accepted::allocations),
                           required("instances", &task_accepted::instances));
  }
};

/// The document of `roscell plan FILE`: a cell on paper and a request to it.
struct plan_document {
  std::vector<node_resources> nodes;
  std::vector<skill_descriptor> skills; ///< Every node has all of them.
  task_request request;

  static constexpr auto fields() {
    return std::make_tuple(required("nodes", &plan_document::nodes),
                           required("skills", &plan_document::skills),
                           required("request", &plan_document::request));
  }
};

} // namespace roscell
