#include "actors/placement/search/report/explain.hpp"

#include "actors/placement/search/allocation.hpp"
#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/report/text.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

/// Names of steps in quotes, with the word before them: "steps 'a' and 'b'".
std::string named(const problem& asked, const std::vector<std::size_t>& steps) {
  std::vector<std::string> names;
  names.reserve(steps.size());
  for (auto i : steps)
    names.push_back(quoted(asked.steps[i].id));
  return (steps.size() == 1 ? "step " : "steps ") + enumerated(names);
}

class explainer {
public:
  explainer(const search_space& space, const std::vector<std::size_t>& conflict)
      : space_(space), conflict_(conflict),
        text_(conflict_text(space.asked, space.candidates, conflict)) {}

  rejected_candidate explain(std::size_t step, const candidate& choice) const {
    std::vector<reason> reasons;
    auto rivals = rivals_of(step, choice.node);
    if (!rivals.empty())
      for (auto kind : {cpu, memory, disk, gpu_memory})
        add_shortage(reasons, kind, step, choice, rivals);
    if (reasons.empty())
      reasons.push_back(
          {reason_kind::combination, 0, 0, 0, "fits alone, but " + text_});
    return rejection(space_.asked, step, choice, std::move(reasons));
  }

private:
  /// The other steps of the conflict that could use this node; none when this
  /// step is not part of it.
  std::vector<std::size_t> rivals_of(std::size_t step, std::size_t node) const {
    std::vector<std::size_t> rivals;
    if (std::find(conflict_.begin(), conflict_.end(), step) == conflict_.end())
      return rivals;
    for (auto other : conflict_) {
      const auto& from = space_.candidates.from[other];
      if (other != step && from[node] < from[node + 1])
        rivals.push_back(other);
    }
    return rivals;
  }

  /// What the candidate takes of the node. GPU memory of a unified-memory
  /// node comes out of its memory.
  double takes(resource kind, std::size_t step, const candidate& choice) const {
    const auto& way = space_.way(step, choice);
    bool unified = space_.asked.nodes[choice.node].unified_memory;
    switch (kind) {
    case cpu:
      return way.cpu;
    case memory:
      return way.memory_mib + (unified ? way.gpu_memory_mib : 0);
    case disk:
      return way.disk_mib;
    default:
      return unified ? 0 : way.gpu_memory_mib;
    }
  }

  double least_takes(resource kind, std::size_t step, std::size_t node) const {
    const auto& from = space_.candidates.from[step];
    auto least = takes(kind, step, space_.choice(step, from[node]));
    for (auto c = from[node] + 1; c < from[node + 1]; ++c)
      least = std::min(least, takes(kind, step, space_.choice(step, c)));
    return least;
  }

  /// Over all GPUs of the node for GPU memory.
  double free(resource kind, std::size_t node) const {
    const auto& host = space_.asked.nodes[node];
    auto left = [](const amount& of) {
      return std::max(0.0, of.capacity - of.used);
    };
    switch (kind) {
    case cpu:
      return left(host.cpu);
    case memory:
      return left(host.memory_mib);
    case disk:
      return left(host.disk_mib);
    default: {
      double sum = 0;
      for (const auto& card : host.gpus)
        sum += left(card.memory_mib);
      return sum;
    }
    }
  }

  void add_shortage(std::vector<reason>& to, resource kind, std::size_t step,
                    const candidate& choice,
                    const std::vector<std::size_t>& rivals) const {
    share together{takes(kind, step, choice), free(kind, choice.node)};
    if (together.request <= 0)
      return;
    for (auto rival : rivals)
      together.request += least_takes(kind, rival, choice.node);
    if (together.fits())
      return;
    to.push_back({reason_kind::combination, together.request, together.free,
                  together.request - together.free,
                  "fits alone, but " + text_ + "; with "
                      + named(space_.asked, rivals) + " this node "
                      + shortage_text(kind, together.request, together.free)});
  }

  const search_space& space_;
  const std::vector<std::size_t>& conflict_;
  const std::string text_;
};

} // namespace

std::vector<rejected_candidate>
explain_conflict(const search_space& space,
                 const std::vector<std::size_t>& conflict) {
  explainer explains(space, conflict);
  std::vector<rejected_candidate> rejected;
  for (std::size_t i = 0; i < space.steps(); ++i)
    for (const auto& choice : space.candidates.of[i])
      rejected.push_back(explains.explain(i, choice));
  return rejected;
}

std::string conflict_text(const problem& asked, const candidate_set& candidates,
                          const std::vector<std::size_t>& conflict) {
  if (conflict.size() > 1)
    return named(asked, conflict) + " cannot be placed together";
  const auto step = conflict.front();
  if (asked.steps[step].deployments.empty())
    return named(asked, conflict) + " has no deployment option to choose from";
  if (asked.nodes.empty())
    return "there is no node";
  return named(asked, conflict)
         + (candidates.of[step].empty() ? " fits on no node"
                                        : " cannot be placed");
}

result alternative(problem asked, const result& chosen, std::size_t step,
                   const limits& bounds) {
  const auto& taken = chosen.placements[step];
  asked.excluded.push_back(
      {step, taken.node, taken.deployment, taken.gpu, "is the one chosen"});
  return allocate(asked, bounds);
}

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
