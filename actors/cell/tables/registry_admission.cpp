#include "actors/cell/limits.hpp"
#include "actors/cell/tables/cell_registry.hpp"

#include "actors/core/limits.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

/// Who gets a row: names, UUIDs, and registrations that are written down.
namespace roscell {

namespace {

failure conflict(std::string message, std::string where, std::string hint) {
  failure result;
  result.code = error_code::conflict;
  result.message = std::move(message);
  result.where = std::move(where);
  result.hint = std::move(hint);
  return result;
}

} // namespace

// -- who may have a row -------------------------------------------------------

bool cell_registry::gives_name_up(const registry_entry& x,
                                  const node_identity& to,
                                  const registry_time& now) const {
  // An earlier version kept records of namesakes: who lives counts.
  const auto* heir = find_uuid(to.uuid);
  if (x.row.state == row_state::expected && heir
      && heir->row.state == row_state::expected
      && heir->row.identity.name == to.name)
    return true;
  const auto away = now.steady - x.inactive_since;
  return (x.row.state == row_state::lost
          && away > limits::membership::name_held)
         || (x.row.state == row_state::expected
             && away > limits::membership::expected_name_held);
}

std::optional<failure>
cell_registry::name_refusal(const node_identity& who,
                            const registry_time& now) const {
  const auto* owner = find_name(who.name);
  if (owner
      && (owner->row.identity.uuid == who.uuid
          || gives_name_up(*owner, who, now)))
    owner = nullptr;
  for (const auto& [uuid, x] : proposed_)
    if (uuid != who.uuid && x.row.identity.name == who.name)
      owner = &x;
  if (!owner)
    return std::nullopt;
  const auto& row = owner->row;
  return conflict(
      "the name '" + who.name + "' belongs to the node with UUID "
          + row.identity.uuid + " at " + row.identity.address,
      "/identity",
      "give the node another --name, or wait until the other one has "
      "been gone for a lease");
}

/// A copy of a data directory has the UUID of a node that lives elsewhere.
std::optional<failure>
cell_registry::copy_refusal(const node_identity& who,
                            const member_actor& gone) const {
  const auto* known = find_uuid(who.uuid);
  const auto proposed = proposed_.find(who.uuid);
  if (proposed != proposed_.end())
    known = &proposed->second;
  if (!known || !known->member || known->member == gone || who.address.empty()
      || known->row.identity.address == who.address)
    return std::nullopt;
  return conflict("this UUID is in use at " + known->row.identity.address
                      + ": its data directory is a copy",
                  "/identity/uuid",
                  "start this node once with --new-identity: then it makes a "
                  "UUID of its own");
}

member_actor cell_registry::rival_of(const node_identity& who) const {
  const auto* known = find_uuid(who.uuid);
  return known && proposed_.count(who.uuid) == 0 && copy_refusal(who, {})
             ? known->member
             : member_actor{};
}

std::optional<failure> cell_registry::refusal(const node_identity& who,
                                              const registry_time& now,
                                              const member_actor& gone) const {
  if (auto why = copy_refusal(who, gone))
    return why;
  const auto* known = find_uuid(who.uuid);
  if (!expects(who.uuid) && is_full())
    return conflict(
        "the cell has " + std::to_string(limits::cell::rows)
            + " nodes, those that are away with them, and takes no more",
        "",
        "let the node join another cell of the site, or release one that will "
        "not come back: `roscell nodes` lists them, `roscell release NODE`");
  if (known && who.epoch < known->row.identity.epoch)
    return conflict("the registration of epoch " + std::to_string(who.epoch)
                        + " is older than epoch "
                        + std::to_string(known->row.identity.epoch)
                        + ", which has been seen",
                    "/identity/epoch", "");
  return name_refusal(who, now);
}

// -- names --------------------------------------------------------------------

void cell_registry::settle_owner(const std::string& name) {
  const auto i = owners_.find(name);
  if (i != owners_.end() && by_uuid_.count(i->second) > 0
      && by_uuid_.at(i->second).row.identity.name == name)
    return;
  owners_.erase(name);
  for (const auto& [uuid, x] : by_uuid_)
    if (x.row.identity.name == name)
      owners_.emplace(name, uuid);
}

const registry_entry* cell_registry::find_name(const std::string& name) const {
  const auto i = owners_.find(name);
  return i == owners_.end() ? nullptr : find_uuid(i->second);
}

registry_entry* cell_registry::find_name(const std::string& name) {
  return const_cast<registry_entry*>(std::as_const(*this).find_name(name));
}

// -- discovery servers --------------------------------------------------------

bool cell_registry::is_full() const {
  const auto coming =
      std::count_if(proposed_.begin(), proposed_.end(), [this](const auto& x) {
        return by_uuid_.count(x.first) == 0;
      });
  return by_uuid_.size() + static_cast<size_t>(coming) >= limits::cell::rows;
}

int64_t
cell_registry::choose_server_id(const std::string& uuid, int64_t last,
                                bool last_is_ours, int64_t own,
                                const std::set<int64_t>& elsewhere) const {
  std::set<int64_t> used{own};
  for (const auto* rows : {&by_uuid_, &proposed_})
    for (const auto& [other, x] : *rows)
      if (other != uuid)
        used.insert(x.server_id);
  const auto is_free = [&](int64_t id) {
    return id >= 0 && used.count(id) == 0 && (last_is_ours || id != last);
  };
  const auto is_good = [&](int64_t id) {
    return is_free(id) && elsewhere.count(id) == 0;
  };
  if (last_is_ours && is_good(last))
    return last;
  if (const auto* known = find_uuid(uuid); known && is_good(known->server_id))
    return known->server_id;
  // Each has as many ids as there are rows and one more; those that other
  // coordinators use come last, for nobody of theirs meets a server of ours.
  static_assert(limits::cell::rows + 2 <= UINT8_MAX + 1,
                "a row, the coordinator, and the id that is avoided");
  for (const bool needs_good : {true, false})
    for (int64_t id = 0; id <= UINT8_MAX; ++id)
      if (needs_good ? is_good(id) : is_free(id))
        return id;
  return -1;
}

// -- a registration -----------------------------------------------------------

std::vector<store_record> cell_registry::propose(registry_entry entry) {
  const auto& who = entry.row.identity;
  std::vector<store_record> result;
  for (const auto& [uuid, x] : by_uuid_)
    if (uuid != who.uuid && x.row.identity.name == who.name)
      result.push_back({"members", uuid, ""});
  result.push_back(
      {"members", who.uuid,
       json(member_record{who, entry.origin, entry.server_id}).dump()});
  proposed_[who.uuid] = std::move(entry);
  return result;
}

registry_entry* cell_registry::accept(const std::string& uuid,
                                      const member_actor& member,
                                      const registry_time& now) {
  const auto i = proposed_.find(uuid);
  if (i == proposed_.end() || i->second.member != member)
    return nullptr;
  auto entry = std::move(i->second);
  proposed_.erase(i);
  return &activate(std::move(entry), now);
}

void cell_registry::withdraw(const std::string& uuid,
                             const member_actor& member) {
  const auto i = proposed_.find(uuid);
  if (i != proposed_.end() && i->second.member == member)
    proposed_.erase(i);
}

void cell_registry::withdraw(const caf::actor_addr& member) {
  for (auto i = proposed_.begin(); i != proposed_.end();)
    if (i->second.member && i->second.member.address() == member)
      i = proposed_.erase(i);
    else
      ++i;
}

bool cell_registry::expects(const std::string& uuid) const {
  return find_uuid(uuid) != nullptr || proposed_.count(uuid) > 0;
}

bool cell_registry::is_known(const node_identity& who, join_origin origin,
                             int64_t server_id) const {
  const auto* x = find_uuid(who.uuid);
  return x && x->row.state != row_state::reserved
         && x->row.identity.name == who.name && x->origin == origin
         && x->server_id == server_id;
}

} // namespace roscell
