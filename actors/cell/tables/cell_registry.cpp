#include "actors/cell/tables/cell_registry.hpp"

#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

ROSCELL_CODEC(member_record)

member_claim claim_of(const registry_row& row) {
  return {row.identity.name, row.identity.uuid, row.identity.epoch,
          row.state == row_state::active};
}

registry_entry&
cell_registry::reserve(const node_identity& who,
                       std::chrono::steady_clock::time_point until,
                       const registry_time& now) {
  auto& entry = by_uuid_[who.uuid];
  if (entry.row.identity.uuid.empty()) {
    entry.row.identity = who;
    entry.row.resources.name = who.name;
    entry.row.state = row_state::reserved;
    entry.row.since_unix_ms = now.unix_ms;
    settle_owner(who.name);
  }
  entry.held_until = until;
  return entry;
}

std::vector<std::string>
cell_registry::drop_overdue(std::chrono::steady_clock::time_point now) {
  std::vector<std::string> result;
  for (const auto& [uuid, entry] : by_uuid_)
    if (entry.row.state == row_state::reserved && entry.held_until <= now)
      result.push_back(uuid);
  for (const auto& uuid : result)
    erase(uuid);
  return result;
}

std::chrono::steady_clock::time_point cell_registry::next_overdue() const {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [uuid, entry] : by_uuid_)
    if (entry.row.state == row_state::reserved)
      result = std::min(result, entry.held_until);
  return result;
}

void cell_registry::expect(const member_record& known,
                           const registry_time& now) {
  auto& entry = by_uuid_[known.identity.uuid];
  entry.row.identity = known.identity;
  entry.row.resources.name = known.identity.name;
  entry.row.since_unix_ms = now.unix_ms;
  entry.row.reason = "not seen since the coordinator was started";
  entry.inactive_since = now.steady;
  entry.origin = known.origin;
  entry.server_id = known.server_id;
  settle_owner(known.identity.name);
}

void cell_registry::depart(registry_entry& entry, const registry_time& now) {
  entry.row.state = row_state::departing;
  entry.row.since_unix_ms = now.unix_ms;
}

void cell_registry::stay(registry_entry& entry, const registry_time& now) {
  entry.row.state = row_state::active;
  entry.row.since_unix_ms = now.unix_ms;
  entry.row.reason.clear();
}

registry_entry& cell_registry::activate(registry_entry entry,
                                        const registry_time& now) {
  const auto who = entry.row.identity;
  std::vector<std::string> displaced;
  for (const auto& [uuid, x] : by_uuid_)
    if (uuid == who.uuid ? x.row.identity.name != who.name
                         : x.row.identity.name == who.name)
      displaced.push_back(uuid);
  for (const auto& uuid : displaced)
    erase(uuid);
  entry.row.state = row_state::active;
  entry.row.since_unix_ms = now.unix_ms;
  entry.row.reason.clear();
  auto& place = by_uuid_[who.uuid];
  place = std::move(entry);
  owners_[who.name] = who.uuid;
  return place;
}

registry_entry* cell_registry::find_member(const std::string& uuid,
                                           const member_actor& member) {
  auto* entry = find_uuid(uuid);
  return entry && entry->member && entry->member == member ? entry : nullptr;
}

registry_entry* cell_registry::find_uuid(const std::string& uuid) {
  auto i = by_uuid_.find(uuid);
  return i == by_uuid_.end() ? nullptr : &i->second;
}

const registry_entry* cell_registry::find_uuid(const std::string& uuid) const {
  const auto i = by_uuid_.find(uuid);
  return i == by_uuid_.end() ? nullptr : &i->second;
}

void cell_registry::deactivate(registry_entry& entry, row_state state,
                               std::string reason, const registry_time& now) {
  entry.row.state = state;
  entry.row.reason = std::move(reason);
  entry.row.since_unix_ms = now.unix_ms;
  entry.inactive_since = now.steady;
  entry.agent = nullptr;
  entry.member = nullptr;
}

void cell_registry::erase(const std::string& uuid) {
  if (const auto row = by_uuid_.extract(uuid))
    settle_owner(row.mapped().row.identity.name);
}

std::vector<registry_row> cell_registry::rows() const {
  std::vector<registry_row> result;
  for (const auto& [uuid, entry] : by_uuid_)
    result.push_back(entry.row);
  std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.identity.name < y.identity.name;
  });
  return result;
}

size_t cell_registry::active_count() const {
  return static_cast<size_t>(
      std::count_if(by_uuid_.begin(), by_uuid_.end(), [](const auto& x) {
        return x.second.row.state == row_state::active;
      }));
}

size_t cell_registry::size() const {
  return static_cast<size_t>(
      std::count_if(by_uuid_.begin(), by_uuid_.end(), [](const auto& x) {
        const auto state = x.second.row.state;
        return state == row_state::active || state == row_state::reserved
               || state == row_state::departing;
      }));
}

std::vector<member_claim> cell_registry::claims() const {
  std::vector<member_claim> result;
  for (const auto& [uuid, entry] : by_uuid_)
    result.push_back(claim_of(entry.row));
  return result;
}

namespace {

/// Adds a node's build to the row of that build.
void add_build(std::map<std::string, skill_row>& by_hash,
               const installed_skill& skill, const std::string& node) {
  auto& row = by_hash[skill.hash];
  row.skill = skill;
  row.skill.added_unix_ms = 0; // Each node has its own.
  const auto at = std::lower_bound(row.nodes.begin(), row.nodes.end(), node);
  row.added_unix_ms.insert(row.added_unix_ms.begin() + (at - row.nodes.begin()),
                           skill.added_unix_ms);
  row.nodes.insert(at, node);
}

} // namespace

std::vector<skill_row>
cell_registry::skills(const std::string& operation) const {
  std::map<std::string, skill_row> by_hash;
  for (const auto& [uuid, entry] : by_uuid_) {
    if (entry.row.state != row_state::active)
      continue;
    for (const auto& skill : entry.skills)
      if (operation.empty() || skill.descriptor.operation == operation)
        add_build(by_hash, skill, entry.row.identity.name);
  }
  std::vector<skill_row> result;
  result.reserve(by_hash.size());
  for (auto& [hash, row] : by_hash)
    result.push_back(std::move(row));
  return result;
}

std::vector<refused_skill> cell_registry::refused_skills() const {
  std::vector<refused_skill> result;
  for (const auto& [uuid, entry] : by_uuid_)
    if (entry.row.state == row_state::active)
      for (const auto& problem : entry.refused_skills)
        result.push_back({entry.row.identity.name, problem});
  std::stable_sort(
      result.begin(), result.end(),
      [](const auto& x, const auto& y) { return x.node < y.node; });
  return result;
}

void cell_registry::for_each(
    const std::function<void(registry_entry&)>& visit) {
  for (auto& [uuid, entry] : by_uuid_)
    visit(entry);
}

void cell_registry::for_each_active(
    const std::function<void(registry_entry&)>& visit) {
  for (auto& [uuid, entry] : by_uuid_)
    if (entry.row.state == row_state::active)
      visit(entry);
}

} // namespace roscell
