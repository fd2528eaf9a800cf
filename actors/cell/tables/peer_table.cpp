#include "actors/cell/tables/peer_table.hpp"

#include "actors/cell/limits.hpp"
#include "dds/server_addresses.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

// -- what is announced --------------------------------------------------------

peer_table::peer_table(std::string self)
    : self_(std::move(self)), calls_{
                                  limits::unauthenticated_peers::peer_calls} {
  // nop
}

size_t peer_table::unauthenticated_peers() const {
  return static_cast<size_t>(
      std::count_if(by_uuid_.begin(), by_uuid_.end(),
                    [](const auto& x) { return !x.second.proved; }));
}

/// Who has failed most often makes room. Nobody does who has not been tried.
bool peer_table::make_room() {
  if (unauthenticated_peers() < limits::unauthenticated_peers::coordinators)
    return true;
  auto worst = by_uuid_.end();
  for (auto i = by_uuid_.begin(); i != by_uuid_.end(); ++i)
    if (!i->second.proved && calls_.failures(i->first) > 0
        && (worst == by_uuid_.end()
            || calls_.failures(i->first) > calls_.failures(worst->first)))
      worst = i;
  if (worst == by_uuid_.end())
    return false;
  calls_.forget(worst->first);
  by_uuid_.erase(worst);
  return true;
}

peer_table::sighting peer_table::see(const node_presence& who, time_point now) {
  if (who.uuid == self_)
    return sighting::ignored;
  auto i = by_uuid_.find(who.uuid);
  if (i == by_uuid_.end()) {
    if (!make_room())
      return sighting::ignored;
    i = by_uuid_.emplace(who.uuid, known{}).first;
  }
  auto& x = i->second;
  if (x.announced == who)
    return sighting::repeated;
  const bool appeared = !x.announced;
  if (appeared)
    x.appeared = now;
  x.announced = who;
  // It has just shown that it lives.
  calls_.hurry(who.uuid, now);
  return appeared ? sighting::appeared : sighting::changed;
}

void peer_table::drop_if_gone(const std::string& uuid) {
  const auto i = by_uuid_.find(uuid);
  if (i == by_uuid_.end() || i->second.announced || i->second.session.actor)
    return;
  calls_.forget(uuid);
  by_uuid_.erase(i);
}

bool peer_table::vanish(const node_presence& who) {
  const auto i = by_uuid_.find(who.uuid);
  if (i == by_uuid_.end() || !i->second.announced
      || i->second.announced->incarnation != who.incarnation)
    return false;
  i->second.announced.reset();
  drop_if_gone(who.uuid);
  return true;
}

bool peer_table::is_announced(const std::string& node_name) const {
  return std::any_of(by_uuid_.begin(), by_uuid_.end(), [&](const auto& x) {
    return x.second.announced && x.second.announced->name == node_name;
  });
}

bool peer_table::expects_statuses(time_point now) const {
  return std::any_of(by_uuid_.begin(), by_uuid_.end(), [&](const auto& x) {
    const auto& entry = x.second;
    return entry.announced && !entry.session.reported
           && now - entry.appeared < limits::cell::sizes
           && calls_.failures(x.first) == 0;
  });
}

// -- sessions that are to be opened -------------------------------------------

/// Of two coordinators the one with the higher UUID opens the session.
bool peer_table::opens_here(const std::string& uuid) const {
  return uuid < self_;
}

bool peer_table::is_wanted(const std::string& uuid, const known& x) const {
  return x.announced && !x.session.actor && opens_here(uuid);
}

std::vector<node_presence> peer_table::begin_due(time_point now) {
  std::vector<const std::pair<const std::string, known>*> wanted;
  for (const auto& x : by_uuid_)
    if (is_wanted(x.first, x.second))
      wanted.push_back(&x);
  // Those that have proved themselves, then those that were tried least.
  std::stable_sort(
      wanted.begin(), wanted.end(), [&](const auto* x, const auto* y) {
        if (x->second.proved != y->second.proved)
          return x->second.proved;
        return calls_.failures(x->first) < calls_.failures(y->first);
      });
  std::vector<node_presence> result;
  for (const auto* x : wanted)
    if (calls_.begin(x->first, now))
      result.push_back(*x->second.announced);
  return result;
}

std::optional<std::string> peer_table::attempt_failed(const std::string& uuid,
                                                      const std::string& reason,
                                                      time_point now) {
  const bool news = calls_.fail(uuid, reason, now);
  const auto i = by_uuid_.find(uuid);
  if (!news || i == by_uuid_.end() || !i->second.announced)
    return std::nullopt;
  return i->second.announced->cell;
}

bool peer_table::attempt_succeeded(const std::string& uuid) {
  return calls_.succeed(uuid) && by_uuid_.count(uuid) > 0;
}

peer_table::time_point peer_table::next_due() const {
  auto result = time_point::max();
  for (const auto& [uuid, x] : by_uuid_)
    if (is_wanted(uuid, x))
      result = std::min(result, calls_.next(uuid));
  return result;
}

// -- sessions that are there --------------------------------------------------

peer_actor peer_table::open(const std::string& uuid, const peer_actor& peer) {
  auto& x = by_uuid_[uuid];
  x.proved = true;
  auto former = std::exchange(x.session, {}).actor;
  x.session.actor = peer;
  return former == peer ? peer_actor{} : former;
}

std::optional<peer_entry> peer_table::close(const std::string& uuid,
                                            const peer_actor& peer,
                                            const std::string& reason,
                                            time_point now) {
  const auto i = by_uuid_.find(uuid);
  if (i == by_uuid_.end() || i->second.session.actor != peer)
    return std::nullopt;
  auto result = std::exchange(i->second.session, {});
  calls_.fail(uuid, reason, now);
  drop_if_gone(uuid);
  return result;
}

std::string peer_table::find_uuid(const caf::actor_addr& peer) const {
  for (const auto& [uuid, x] : by_uuid_)
    if (x.session.actor && x.session.actor.address() == peer)
      return uuid;
  return {};
}

const peer_entry* peer_table::find_session(const peer_actor& peer) const {
  return peer ? find(find_uuid(peer.address())) : nullptr;
}

peer_entry* peer_table::find_session(const peer_actor& peer) {
  return const_cast<peer_entry*>(std::as_const(*this).find_session(peer));
}

peer_entry* peer_table::note_status(const peer_actor& peer,
                                    const cell_standing& status) {
  auto* entry = find_session(peer);
  if (!entry)
    return nullptr;
  entry->reported = true;
  entry->status = status;
  entry->members.clear();
  for (const auto& claim : status.members)
    entry->members[claim.uuid] = claim;
  calls_.forget(status.uuid);
  return entry;
}

peer_entry* peer_table::note_status(const peer_actor& peer,
                                    const cell_changed& change) {
  auto* entry = find_session(peer);
  if (!entry || !entry->reported)
    return nullptr;
  entry->status.size = change.size;
  for (const auto& uuid : change.gone)
    entry->members.erase(uuid);
  for (const auto& claim : change.changed)
    entry->members[claim.uuid] = claim;
  return entry;
}

const peer_entry* peer_table::find(const std::string& uuid) const {
  const auto i = by_uuid_.find(uuid);
  return i != by_uuid_.end() && i->second.session.actor ? &i->second.session
                                                        : nullptr;
}

peer_entry* peer_table::find(const std::string& uuid) {
  return const_cast<peer_entry*>(std::as_const(*this).find(uuid));
}

void peer_table::for_each_session(
    const std::function<void(const std::string&, const peer_entry&)>& visit)
    const {
  for (const auto& [uuid, x] : by_uuid_)
    if (x.session.actor)
      visit(uuid, x.session);
}

const peer_entry* peer_table::find_cell(const std::string& cell) const {
  const peer_entry* result = nullptr;
  for_each_session([&](const std::string&, const peer_entry& x) {
    if (!result && x.reported && x.status.place.cell == cell)
      result = &x;
  });
  return result;
}

const peer_entry* peer_table::find_holder(const std::string& node) const {
  const peer_entry* result = nullptr;
  int64_t epoch = -1;
  for_each_session([&](const std::string&, const peer_entry& x) {
    for (const auto& [member, claim] : x.members) {
      if (claim.name != node || claim.epoch <= epoch)
        continue;
      result = &x;
      epoch = claim.epoch;
    }
  });
  return result;
}

namespace {

/// What a ROS 2 program needs to be in that cell.
std::map<std::string, std::string> environment_of(const cell_standing& status) {
  if (status.server_id < 0 || status.domain_id < 0)
    return {};
  return {{"ROS_DOMAIN_ID", std::to_string(status.domain_id)},
          {"ROS_DISCOVERY_SERVER",
           ros_discovery_server(static_cast<uint8_t>(status.server_id),
                                status.place.discovery_server)}};
}

} // namespace

std::set<int64_t> peer_table::server_ids() const {
  std::set<int64_t> result;
  for (const auto& [uuid, x] : by_uuid_) {
    if (x.announced)
      result.insert(x.announced->server_id);
    if (x.session.reported)
      result.insert(x.session.status.server_id);
  }
  return result;
}

std::vector<cell_row> peer_table::rows(const cell_row& own) const {
  std::vector<cell_row> result;
  for (const auto& [uuid, x] : by_uuid_) {
    cell_row row;
    if (x.session.reported) {
      const auto& place = x.session.status.place;
      row = {place.cell,
             place.coordinator,
             place.address,
             place.discovery_server,
             x.session.status.size,
             "",
             environment_of(x.session.status)};
    } else if (x.announced) {
      row = {x.announced->cell,
             x.announced->name,
             x.announced->address,
             x.announced->discovery_server,
             0,
             calls_.problem(uuid),
             {}};
    } else {
      continue;
    }
    if (row.cell == own.cell)
      row.problem =
          "it claims the same name as the cell of '" + own.coordinator + "'";
    result.push_back(std::move(row));
  }
  return result;
}

} // namespace roscell
