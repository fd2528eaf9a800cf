#include "actors/placement/search/candidates.hpp"

#include "actors/placement/search/report/text.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

using reason_list = std::vector<reason>;

void add(reason_list& to, reason_kind kind, std::string text) {
  to.push_back({kind, 0, 0, 0, std::move(text)});
}

void add_shortage(reason_list& to, resource kind, const share& of) {
  if (!of.fits())
    to.push_back({kind_of(kind), of.request, of.free, of.request - of.free,
                  shortage_text(kind, of.request, of.free)});
}

template <class List>
bool has(const List& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

void check_architecture(reason_list& to, const node& host,
                        const deployment& way) {
  if (way.architectures.empty() || has(way.architectures, host.architecture))
    return;
  add(to, reason_kind::architecture,
      "runs on " + enumerated(way.architectures) + ", the node is "
          + quoted(host.architecture));
}

std::string quoted_pair(const std::string& key, const std::string& value) {
  return quoted(key + "=" + value);
}

void check_labels(reason_list& to, const node& host, const label_map& wanted) {
  for (const auto& [key, value] : wanted) {
    auto found = host.labels.find(key);
    if (found != host.labels.end() && found->second == value)
      continue;
    auto text = "needs the label " + quoted_pair(key, value);
    if (found == host.labels.end())
      text.append(", the node has no label ").append(quoted(key));
    else
      text.append(", the node has ").append(quoted_pair(key, found->second));
    add(to, reason_kind::label, std::move(text));
  }
}

void check_kind(reason_list& to, const node& host, const step& wanted,
                const deployment& way, const candidate& choice) {
  if (wanted.nodes_with_skill.count(host.name) == 0)
    add(to, reason_kind::skill, "the node does not have the skill");
  check_architecture(to, host, way);
  check_labels(to, host, wanted.labels);
  check_labels(to, host, way.labels);
  for (const auto& device : way.devices)
    if (!has(host.devices, device))
      add(to, reason_kind::device,
          "needs the device " + quoted(device) + ", the node does not have it");
  for (const auto& secret : wanted.secrets)
    if (!has(host.secrets, secret))
      add(to, reason_kind::secret,
          "needs the secret " + quoted(secret)
              + ", the node does not have it: `roscell secret set " + secret
              + "` there");
  if (way.needs_gpu && choice.gpu < 0)
    add(to, reason_kind::gpu, "needs a GPU, the node has none");
}

/// On unified memory the two requests come out of one pool, and are short of
/// it together.
void check_pool(reason_list& to, const deployment& way, const shares& all) {
  share pool{way.memory_mib + way.gpu_memory_mib,
             all.of[gpu_memory].free + way.memory_mib};
  if (!all.of[memory].fits() || !all.of[gpu_memory].fits())
    to.push_back(
        {reason_kind::memory, pool.request, pool.free, pool.request - pool.free,
         "needs " + mebibytes(way.memory_mib) + " MiB of memory and "
             + mebibytes(way.gpu_memory_mib)
             + " MiB of GPU memory out of one pool, " + mebibytes(pool.free)
             + " free: short by " + mebibytes(pool.request - pool.free)});
}

void check_amounts(reason_list& to, const node& host, const deployment& way,
                   const shares& all) {
  if (host.cpu.capacity <= 0)
    add(to, reason_kind::cpu, "the node offers no CPU");
  else
    add_shortage(to, cpu, all.of[cpu]);
  if (host.memory_mib.capacity <= 0)
    add(to, reason_kind::memory, "the node offers no memory");
  else if (host.unified_memory && all.count > gpu_memory)
    check_pool(to, way, all);
  else
    add_shortage(to, memory, all.of[memory]);
  add_shortage(to, disk, all.of[disk]);
  if (all.count > gpu_memory && !host.unified_memory)
    add_shortage(to, gpu_memory, all.of[gpu_memory]);
}

int index_of(const problem& asked, const candidate& choice) {
  return choice.gpu < 0 ? -1 : asked.nodes[choice.node].gpus[choice.gpu].index;
}

void check_exclusions(reason_list& to, const problem& asked, std::size_t step,
                      const candidate& choice) {
  for (const auto& one : asked.excluded)
    if (one.step == step && one.node == choice.node
        && one.deployment == choice.deployment
        && one.gpu == index_of(asked, choice))
      add(to, reason_kind::excluded, one.reason);
}

/// On the wire, where earlier versions take no other word: so a secret has none
/// of its own.
const char* const names[] = {
    "skill", "architecture", "label", "device",     "excluded",    "gpu",
    "cpu",   "memory",       "disk",  "gpu_memory", "combination", "excluded"};

} // namespace

const char* to_string(reason_kind kind) {
  return names[static_cast<std::size_t>(kind)];
}

reason_kind kind_of(resource kind) {
  constexpr reason_kind kinds[] = {reason_kind::cpu, reason_kind::memory,
                                   reason_kind::disk, reason_kind::gpu_memory};
  return kinds[kind];
}

std::string shortage_text(resource kind, double needed, double free) {
  constexpr const char* units[] = {" cores", " MiB of memory", " MiB of disk",
                                   " MiB of GPU memory"};
  auto number = kind == cpu ? cores : mebibytes;
  return "needs " + number(needed) + units[kind] + ", " + number(free)
         + " free: short by " + number(needed - free);
}

std::vector<reason> reasons_against(const problem& asked, const occupancy& now,
                                    std::size_t step, const candidate& choice) {
  const auto& host = asked.nodes[choice.node];
  const auto& way = asked.steps[step].deployments[choice.deployment];
  std::vector<reason> found;
  check_kind(found, host, asked.steps[step], way, choice);
  check_amounts(found, host, way, now.shares_of(way, choice));
  check_exclusions(found, asked, step, choice);
  return found;
}

rejected_candidate rejection(const problem& asked, std::size_t step,
                             const candidate& choice,
                             std::vector<reason> reasons) {
  return {step, choice.node, choice.deployment, index_of(asked, choice),
          std::move(reasons)};
}

} // namespace roscell::allocation
