#include "actors/cell/state/build_offers.hpp"

#include "actors/builds/build_permits.hpp"
#include "actors/builds/limits.hpp"
#include "actors/edge/io/crypto.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace roscell {

namespace {

bool has_build(const registry_entry& entry, const std::string& hash) {
  return std::any_of(entry.skills.begin(), entry.skills.end(),
                     [&](const auto& x) { return x.hash == hash; });
}

bool keeps(const cell_build& build, const std::string& node) {
  return std::find(build.keepers.begin(), build.keepers.end(), node)
         != build.keepers.end();
}

/// "ADDR" of "ADDR:PORT".
std::string host_of(const std::string& address) {
  return address.substr(0, address.rfind(':'));
}

/// A node that has to let go a build is no candidate for it.
void hide_remains(const cell_coordinator_state& st, skill_row& row) {
  const auto* remains = st.builds.find_remains(row.skill.hash);
  if (remains == nullptr)
    return;
  skill_row left{row.skill, {}, {}};
  for (size_t i = 0; i < row.nodes.size(); ++i)
    if (std::find(remains->nodes.begin(), remains->nodes.end(), row.nodes[i])
        == remains->nodes.end()) {
      left.nodes.push_back(row.nodes[i]);
      left.added_unix_ms.push_back(row.added_unix_ms[i]);
    }
  row = std::move(left);
}

/// Adds to the skills that nodes have those that they can get. There may be a
/// thousand builds and hundreds of nodes: each is looked up once.
class reach_writer {
public:
  reach_writer(const cell_coordinator_state& st, skill_list& to) : to_(to) {
    for (size_t i = 0; i < to.skills.size(); ++i)
      rows_[to.skills[i].skill.hash] = i;
    for (auto& row : st.registry.rows())
      if (row.state == row_state::active
          && st.registry.find_uuid(row.identity.uuid)->fetches_builds)
        nodes_.emplace_back(std::move(row.identity.name),
                            std::move(row.resources.architecture));
  }

  /// When it was added counts for all nodes, so that where a copy lies does not
  /// decide which build is newer.
  void add(const cell_build& build) {
    auto& row = row_of(build.skill);
    const std::set<std::string> have(row.nodes.begin(), row.nodes.end());
    row.bytes = build.build.bytes;
    row.added_unix_ms.assign(row.nodes.size(), build.added_unix_ms);
    for (const auto& [name, architecture] : nodes_) {
      if (have.count(name) != 0
          || !runs_on_architecture(build.skill, architecture))
        continue;
      row.nodes.push_back(name);
      row.added_unix_ms.push_back(build.added_unix_ms);
      if (!keeps(build, name))
        row.lacking.push_back(name);
    }
  }

private:
  /// Of a build that nodes have already, or a new one.
  skill_row& row_of(const installed_skill& skill) {
    const auto [at, is_new] = rows_.try_emplace(skill.hash, to_.skills.size());
    if (is_new)
      to_.skills.push_back({skill, {}, {}});
    return to_.skills[at->second];
  }

  skill_list& to_;
  std::map<std::string, size_t> rows_; ///< By hash.
  /// Those that get builds: name and architecture.
  std::vector<std::pair<std::string, std::string>> nodes_;
};

/// What lies on nodes unsigned, or was added before signatures were asked for.
void leave_out_unsigned(const cell_coordinator_state& st, skill_list& list) {
  std::set<std::string> known;
  for (const auto& build : st.builds.of(""))
    if (!build.signed_by.empty())
      known.insert(build.build.hash);
  auto& all = list.skills;
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const skill_row& row) {
                             return known.count(row.skill.hash) == 0;
                           }),
            all.end());
}

} // namespace

std::string new_build_key() {
  constexpr size_t key_bytes = 32;
  return to_hex(random_bytes(key_bytes));
}

build_offer offer_from(const cell_coordinator_state& st,
                       const build_name& build, const std::string& node,
                       const std::vector<std::string>& givers) {
  build_offer result{build, {}};
  const auto* reader = st.registry.find_name(node);
  if (reader == nullptr)
    return result;
  const auto reads_from = host_of(reader->row.identity.address);
  for (const auto& name : std::set<std::string>(givers.begin(), givers.end())) {
    const auto* entry = st.registry.find_name(name);
    if (entry == nullptr || name == node
        || entry->row.state != row_state::active || entry->build_key.empty()
        || result.sources.size() == limits::build::sources)
      continue;
    result.sources.push_back(
        {name, entry->row.identity.address,
         build_permits::sign(entry->build_key, build.hash, reads_from)});
  }
  return result;
}

build_offer offer_for(const cell_coordinator_state& st, const std::string& hash,
                      const std::string& node,
                      const std::vector<std::string>& beside) {
  const auto* reader = st.registry.find_name(node);
  if (reader == nullptr || has_build(*reader, hash))
    return {};
  const auto build = st.builds.find(hash);
  if (!build)
    return {};
  return offer_of(st, *build, node, beside);
}

std::vector<std::string> nodes_with(const cell_coordinator_state& st,
                                    const std::string& hash) {
  std::vector<std::string> result;
  for (const auto& x : st.registry.rows())
    if (has_build(*st.registry.find_uuid(x.identity.uuid), hash))
      result.push_back(x.identity.name);
  return result;
}

build_offer offer_of(const cell_coordinator_state& st, const cell_build& build,
                     const std::string& node,
                     const std::vector<std::string>& beside) {
  auto givers = beside;
  givers.insert(givers.end(), build.keepers.begin(), build.keepers.end());
  for (auto& name : nodes_with(st, build.build.hash))
    givers.push_back(std::move(name));
  return offer_from(st, build.build, node, givers);
}

std::vector<build_offer> offers_for(const cell_coordinator_state& st,
                                    const std::vector<instance_spec>& specs,
                                    const std::vector<std::string>& nodes) {
  std::vector<build_offer> result;
  for (size_t i = 0; i < specs.size(); ++i) {
    std::vector<std::string> beside;
    for (size_t j = 0; j < specs.size(); ++j)
      if (specs[j].skill == specs[i].skill)
        beside.push_back(nodes[j]);
    result.push_back(offer_for(st, specs[i].skill, nodes[i], beside));
  }
  return result;
}

std::vector<cell_build> describe_builds(const cell_coordinator_state& st,
                                        const skill_query& query) {
  auto result = st.builds.of(query.operation);
  std::map<std::string, cell_build*> by_hash;
  for (auto& x : result) {
    by_hash[x.build.hash] = &x;
    if (query.brief)
      x.skill.descriptor.models.clear();
  }
  std::map<std::string, std::set<std::string>> coming_to;
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& x : st.deployments.of_task(task)) {
      const auto found = by_hash.find(x.spec.skill);
      if (x.end || found == by_hash.end())
        continue;
      ++found->second->instances;
      const auto* node = st.registry.find_name(x.node);
      if (node != nullptr && !has_build(*node, x.spec.skill))
        coming_to[x.spec.skill].insert(x.node);
    }
  for (const auto& [hash, nodes] : coming_to)
    by_hash.at(hash)->coming_to.assign(nodes.begin(), nodes.end());
  return result;
}

skill_list skills_within_reach(const cell_coordinator_state& st) {
  skill_list result{st.registry.skills(""), st.registry.refused_skills()};
  for (auto& row : result.skills)
    hide_remains(st, row);
  reach_writer writer{st, result};
  for (const auto& build : st.builds.of(""))
    writer.add(build);
  if (st.setup.require_signed_skills)
    leave_out_unsigned(st, result);
  return result;
}

} // namespace roscell
