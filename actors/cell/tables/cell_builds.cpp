#include "actors/cell/tables/cell_builds.hpp"

#include "actors/cell/limits.hpp"
#include "messages/codec/instantiate.hpp"
#include "messages/codec/json_codec.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace roscell {

ROSCELL_CODEC(build_remains)

namespace {

std::string shown(const std::string& hash) {
  constexpr size_t digits = 12;
  return hash.substr(0, digits);
}

/// A script is for every architecture.
bool shares_architecture(const installed_skill& a, const installed_skill& b) {
  if (a.architectures.empty() || b.architectures.empty())
    return true;
  return std::any_of(
      a.architectures.begin(), a.architectures.end(), [&](const auto& x) {
        return std::find(b.architectures.begin(), b.architectures.end(), x)
               != b.architectures.end();
      });
}

} // namespace

/// What it is found by is said by the table.
cell_build cell_builds::unpack(const std::string& hash, const packed_build& x) {
  auto result = json::from_cbor(x.rest.begin(), x.rest.end()).get<cell_build>();
  result.build.hash = hash;
  result.skill.hash = hash;
  result.skill.version = x.version;
  result.skill.descriptor.operation = x.operation;
  return result;
}

std::optional<failure> cell_builds::refusal(const cell_build& x) const {
  const auto& skill = x.skill;
  for (const auto& [hash, packed] : builds_) {
    if (hash == x.build.hash || packed.operation != skill.descriptor.operation
        || packed.version != skill.version
        || !shares_architecture(unpack(hash, packed).skill, skill))
      continue;
    return failure{error_code::conflict,
                   "version " + skill.version + " of '"
                       + skill.descriptor.operation + "' is build "
                       + shown(hash) + " already",
                   "/build",
                   "raise the version in the skill's descriptor, or remove "
                   "that build first"};
  }
  if (builds_.size() >= limits::build::of_cell
      && builds_.count(x.build.hash) == 0)
    return failure{error_code::conflict,
                   "the cell has " + std::to_string(builds_.size())
                       + " builds already",
                   "", "remove some that are not needed any more"};
  return std::nullopt;
}

void cell_builds::add(const cell_build& x) {
  auto rest = x;
  rest.build.hash.clear();
  rest.skill.hash.clear();
  rest.skill.version.clear();
  rest.skill.descriptor.operation.clear();
  packed_build packed{x.skill.descriptor.operation, x.skill.version, {}};
  json::to_cbor(json(rest), packed.rest);
  packed.rest.shrink_to_fit();
  builds_[x.build.hash] = std::move(packed);
  remains_.erase(x.build.hash);
}

void cell_builds::remove(const build_remains& remains) {
  builds_.erase(remains.hash);
  restore(remains);
}

void cell_builds::restore(const build_remains& remains) {
  if (remains.nodes.empty() || builds_.count(remains.hash) != 0)
    return;
  if (remains_.size() == limits::build::remains)
    remains_.erase(std::min_element(
        remains_.begin(), remains_.end(), [](const auto& a, const auto& b) {
          return a.second.removed_unix_ms < b.second.removed_unix_ms;
        }));
  remains_[remains.hash] = remains;
}

std::vector<std::string>
cell_builds::remains_on(const std::string& node) const {
  std::vector<std::string> result;
  for (const auto& [hash, x] : remains_)
    if (std::find(x.nodes.begin(), x.nodes.end(), node) != x.nodes.end())
      result.push_back(hash);
  return result;
}

bool cell_builds::release(const std::string& hash, const std::string& node) {
  const auto found = remains_.find(hash);
  if (found == remains_.end())
    return false;
  auto& nodes = found->second.nodes;
  nodes.erase(std::remove(nodes.begin(), nodes.end(), node), nodes.end());
  if (!nodes.empty())
    return false;
  remains_.erase(found);
  return true;
}

const build_remains* cell_builds::find_remains(const std::string& hash) const {
  const auto found = remains_.find(hash);
  return found == remains_.end() ? nullptr : &found->second;
}

std::optional<cell_build> cell_builds::find(const std::string& hash) const {
  const auto found = builds_.find(hash);
  if (found == builds_.end())
    return std::nullopt;
  return unpack(hash, found->second);
}

std::vector<cell_build> cell_builds::of(const std::string& operation) const {
  std::vector<cell_build> result;
  for (const auto& [hash, x] : builds_)
    if (operation.empty() || x.operation == operation)
      result.push_back(unpack(hash, x));
  std::sort(result.begin(), result.end(), [](const auto& a, const auto& b) {
    return std::tie(a.skill.descriptor.operation, b.added_unix_ms)
           < std::tie(b.skill.descriptor.operation, a.added_unix_ms);
  });
  return result;
}

size_t cell_builds::size() const {
  return builds_.size();
}

bool runs_on_architecture(const installed_skill& skill,
                          const std::string& architecture) {
  const auto& all = skill.architectures;
  return all.empty()
         || std::find(all.begin(), all.end(), architecture) != all.end();
}

} // namespace roscell
