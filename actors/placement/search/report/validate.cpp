#include "actors/placement/search/report/validate.hpp"

#include "actors/placement/search/report/text.hpp"

#include <set>
#include <sstream>

namespace roscell::allocation {

namespace {

using problem_text = std::optional<std::string>;

std::string at(const std::string& list, std::size_t position) {
  return list + "[" + std::to_string(position) + "]";
}

problem_text bad_number(const std::string& place, double number, double least,
                        double most) {
  // Not a number compares false with everything.
  if (number >= least && number <= most)
    return std::nullopt;
  std::ostringstream text;
  text << place << " is " << number << ", not a number from " << least << " to "
       << most;
  return text.str();
}

problem_text bad_amount(const std::string& place, const amount& given) {
  auto bad = bad_number(place + ".capacity", given.capacity, 0, max_amount);
  if (!bad)
    bad = bad_number(place + ".used", given.used, 0, max_amount);
  return bad;
}

/// Says that a name is empty or that `seen` has it already, else records it.
problem_text bad_name(const std::string& place, const std::string& name,
                      std::set<std::string>& seen) {
  if (name.empty())
    return place + " is empty";
  if (!seen.insert(name).second)
    return place + " " + quoted(name) + " is given twice";
  return std::nullopt;
}

problem_text bad_gpus(const std::string& place, const node& host) {
  std::set<int> seen;
  for (std::size_t i = 0; i < host.gpus.size(); ++i) {
    const auto& card = host.gpus[i];
    auto here = at(place + ".gpus", i);
    if (card.index < 0)
      return here + ".index is " + std::to_string(card.index)
             + ", not 0 or more";
    if (!seen.insert(card.index).second)
      return here + ".index " + std::to_string(card.index) + " is given twice";
    if (auto bad = bad_amount(here + ".memory_mib", card.memory_mib))
      return bad;
  }
  return std::nullopt;
}

problem_text bad_node(const std::string& place, const node& host) {
  auto bad = bad_amount(place + ".cpu", host.cpu);
  if (!bad)
    bad = bad_number(place + ".cpu_compressible", host.cpu_compressible, 0,
                     max_amount);
  if (!bad)
    bad = bad_amount(place + ".memory_mib", host.memory_mib);
  if (!bad)
    bad = bad_amount(place + ".disk_mib", host.disk_mib);
  if (!bad)
    bad = bad_gpus(place, host);
  return bad;
}

problem_text bad_deployment(const std::string& place, const deployment& way) {
  auto bad = bad_number(place + ".cpu", way.cpu, 0, max_amount);
  if (!bad)
    bad = bad_number(place + ".memory_mib", way.memory_mib, 0, max_amount);
  if (!bad)
    bad = bad_number(place + ".disk_mib", way.disk_mib, 0, max_amount);
  if (!bad)
    bad = bad_number(place + ".gpu_memory_mib", way.gpu_memory_mib, 0,
                     max_amount);
  if (!bad && !way.needs_gpu && way.gpu_memory_mib > 0)
    return place + ".gpu_memory_mib is above 0 without a need for a GPU";
  return bad;
}

problem_text bad_step(const std::string& place, const step& asked) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < asked.deployments.size(); ++i) {
    auto here = at(place + ".deployments", i);
    auto bad = bad_name(here + ".name", asked.deployments[i].name, names);
    if (!bad)
      bad = bad_deployment(here, asked.deployments[i]);
    if (bad)
      return bad;
  }
  return std::nullopt;
}

problem_text too_many(const problem& asked) {
  if (asked.steps.size() > max_steps)
    return "steps: " + std::to_string(asked.steps.size())
           + " are given, the most is " + std::to_string(max_steps);
  std::size_t gpus = 0;
  for (const auto& host : asked.nodes)
    gpus += host.gpus.size();
  std::size_t candidates = 0;
  for (const auto& wanted : asked.steps)
    for (const auto& way : wanted.deployments)
      candidates += asked.nodes.size() + (way.needs_gpu ? gpus : 0);
  if (candidates > max_candidates)
    return "steps and nodes: they make up to " + std::to_string(candidates)
           + " candidates, the most is " + std::to_string(max_candidates);
  return std::nullopt;
}

problem_text bad_nodes(const problem& asked) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < asked.nodes.size(); ++i) {
    auto here = at("nodes", i);
    auto bad = bad_name(here + ".name", asked.nodes[i].name, names);
    if (!bad)
      bad = bad_node(here, asked.nodes[i]);
    if (bad)
      return bad;
  }
  return std::nullopt;
}

problem_text bad_steps(const problem& asked) {
  if (asked.steps.empty())
    return "steps is empty";
  std::set<std::string> ids;
  for (std::size_t i = 0; i < asked.steps.size(); ++i) {
    auto here = at("steps", i);
    auto bad = bad_name(here + ".id", asked.steps[i].id, ids);
    if (!bad)
      bad = bad_step(here, asked.steps[i]);
    if (bad)
      return bad;
  }
  return std::nullopt;
}

void warn_if_over(const std::string& what, const amount& given,
                  std::string (*number)(double), const char* unit,
                  std::vector<std::string>& warnings) {
  if (given.used > given.capacity)
    warnings.push_back(what + " has " + number(given.used) + " of "
                       + number(given.capacity) + " " + unit
                       + " used; it counts as full");
}

} // namespace

std::optional<std::string> validate(const problem& asked) {
  auto bad = bad_number("alpha", asked.alpha, 0, max_weight);
  if (!bad)
    bad = bad_number("gpu_bonus", asked.gpu_bonus, -max_weight, max_weight);
  if (!bad)
    bad = too_many(asked);
  if (!bad)
    bad = bad_nodes(asked);
  if (!bad)
    bad = bad_steps(asked);
  return bad;
}

std::vector<std::string> warnings_about(const problem& asked) {
  std::vector<std::string> found;
  for (const auto& host : asked.nodes) {
    auto name = "node " + quoted(host.name);
    warn_if_over(name, host.cpu, cores, "cores", found);
    warn_if_over(name, host.memory_mib, mebibytes, "MiB of memory", found);
    warn_if_over(name, host.disk_mib, mebibytes, "MiB of disk", found);
    if (host.unified_memory)
      continue;
    for (const auto& card : host.gpus)
      warn_if_over("GPU " + std::to_string(card.index) + " of " + name,
                   card.memory_mib, mebibytes, "MiB of memory", found);
  }
  return found;
}

} // namespace roscell::allocation
