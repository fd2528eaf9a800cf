#include "test/site/watch/site_watch.hpp"

#include "test/site/watch/task_rest.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <tuple>
#include <utility>

namespace roscell::test {

namespace {

const registry_entry* row_of(const site_party& coordinator,
                             const site_party& node) {
  if (!coordinator.alive())
    return nullptr;
  return coordinator.cell_state().registry.find_uuid(node.uuid);
}

bool is_active(const site_party& coordinator, const site_party& node) {
  const auto* row = row_of(coordinator, node);
  return row && row->row.state == row_state::active;
}

bool believes(const site_party& node, const site_party& coordinator) {
  if (!node.alive())
    return false;
  const auto& st = node.status();
  return st.state == node_state::member && st.cell == coordinator.cell;
}

/// Whether the two have told each other how they stand, and hear each other.
bool are_connected(const site& place, const site_party& x,
                   const site_party& y) {
  if (!x.alive() || !y.alive() || !place.reachable(x.index, y.index))
    return false;
  const auto knows = [](const site_party& a, const site_party& b) {
    const auto* entry = a.cell_state().peers.find(b.uuid);
    return entry && entry->reported;
  };
  if (!knows(x, y) || !knows(y, x))
    return false;
  return std::none_of(place.connections.begin(), place.connections.end(),
                      [&](const auto& c) {
                        const auto& [a, b] = c.parties;
                        const bool theirs = (a == x.index && b == y.index)
                                            || (a == y.index && b == x.index);
                        return theirs && c.link->silent;
                      });
}

std::string state_word(const site_party& node) {
  return std::string{to_word(node.status().state)} + "/"
         + std::string{to_word(node.status().phase)} + " of '"
         + node.status().cell + "' at epoch "
         + std::to_string(node.status().config.identity.epoch);
}

/// A node that does not come back is missed, and that is all.
std::string retired_complaint(const site& place, const site_party& node) {
  std::string result;
  for (const auto& c : place.parties) {
    const auto* row = c->coordinates ? row_of(*c, node) : nullptr;
    if (row && row->row.state != row_state::lost
        && row->row.state != row_state::expected)
      result += node.name + ", which is gone, is "
                + std::string{to_word(row->row.state)} + " at " + c->cell
                + "; ";
  }
  return result;
}

/// One node against all registries.
std::string node_complaint(const site& place, const site_party& node) {
  if (!node.alive())
    return node.retired ? retired_complaint(place, node)
                        : node.name + " is dead; ";
  const auto& st = node.status();
  std::string result;
  const auto add = [&](const std::string& what) {
    result += node.name + " (" + state_word(node) + ") " + what + "; ";
  };
  if (st.state != node_state::member
      && (st.state != node_state::independent || st.seeking))
    add("has not come to rest");
  const bool belongs = st.state == node_state::member;
  if (belongs == node.announced.has_value())
    add(belongs ? "announces itself" : "announces nothing");
  for (const auto& c : place.parties) {
    if (!c->coordinates)
      continue;
    const auto* row = row_of(*c, node);
    const bool mine = believes(node, *c);
    if (mine && (!row || row->row.state != row_state::active))
      add("is not active at " + c->cell);
    else if (mine && row->row.identity.epoch != st.config.identity.epoch)
      add("has another epoch at " + c->cell);
    else if (!mine && row)
      add("has a row at " + c->cell + ": "
          + std::string{to_word(row->row.state)} + " of epoch "
          + std::to_string(row->row.identity.epoch));
  }
  return result;
}

bool is_of_retired(const site& place, const transfer_row& transfer) {
  return std::any_of(
      place.parties.begin(), place.parties.end(),
      [&](const auto& x) { return x->retired && x->uuid == transfer.uuid; });
}

std::string cell_complaint(const site& place, const site_party& x) {
  if (!x.alive())
    return x.name + " is dead; ";
  std::string result;
  const auto& st = x.cell_state();
  for (const auto& row : st.transfers.rows())
    if (row.state != transfer_state::done
        && row.state != transfer_state::returned && !is_of_retired(place, row))
      result += "transfer " + row.transfer + " is "
                + std::string{to_word(row.state)} + "; ";
  const auto stored = x.disk.find("transfers");
  if (stored != x.disk.end())
    for (const auto& [id, record] : stored->second)
      if (st.transfers.rows(id).empty())
        result += "transfer " + id + " is forgotten and on disk; ";
  for (const auto& y : place.parties)
    if (y->coordinates && y->index < x.index && !are_connected(place, x, *y))
      result += x.cell + " and " + y->cell + " are not connected; ";
  return result;
}

} // namespace

std::string complaint(const site& place) {
  std::string result;
  for (const auto& x : place.parties)
    result +=
        x->coordinates ? cell_complaint(place, *x) : node_complaint(place, *x);
  for (const auto& request : place.requests)
    if (!request.closed && !request.is_answered())
      result += "no answer to " + request.text + "; ";
  return result + task_complaint(place);
}

std::string old_registrations(const site& place) {
  std::string result;
  // By coordinator, its life and the node.
  std::map<std::tuple<size_t, unsigned, std::string>, int64_t> newest;
  for (const auto& x : place.events) {
    const std::tuple key{x.party, x.life, x.subject};
    if (x.what == "node_left")
      newest.erase(key);
    if (x.what != "node_joined")
      continue;
    const auto epoch = x.data.at("epoch").get<int64_t>();
    auto& known = newest[key];
    if (epoch < known)
      result += place.parties[x.party]->cell + " has taken epoch "
                + std::to_string(epoch) + " of " + x.subject + " after epoch "
                + std::to_string(known) + "; ";
    known = std::max(known, epoch);
  }
  return result;
}

/// A step that waits for its node is no complaint, until it is moved: then it
/// is one while it starts.
bool stays_calm(site& place) {
  if (!complaint(place).empty())
    return false;
  place.pass(10s);
  return complaint(place).empty();
}

std::string calm_down(site& place) {
  place.faults = {};
  place.drop_call = 0;
  place.judge = nullptr;
  place.heal_all();
  // TCP delivers in the end, or the connection breaks.
  for (auto& c : place.connections)
    if (c.link->lossy)
      cut(*c.link);
  for (auto& x : place.parties) {
    x->disk_full = false;
    x->builds_fail = false;
    if (!x->retired)
      place.start(*x);
  }
  // What was held up arrives.
  place.pass(10s);
  // A place is kept for two minutes; whatever waits for an answer that got lost
  // inside a session that lives has a quarter of an hour.
  for (auto left = 18 * 60s; left > 0s && !stays_calm(place);) {
    const auto step = left > 14 * 60s ? 2s : 30s;
    place.pass(step);
    left -= step;
  }
  return complaint(place);
}

std::string release_retired(site& place) {
  std::string result;
  for (const auto& node : place.parties)
    for (const auto& c : place.parties) {
      if (!node->retired || !c->coordinates || !row_of(*c, *node))
        continue;
      auto reply = place.time.ask<node_released>(
          c->coordinator, node_release{node->name, instance_policy::terminate});
      place.pass(60s);
      if (!reply->has_value() || !**reply || row_of(*c, *node))
        result += c->cell + " does not let " + node->name + " go; ";
    }
  return result;
}

void site_watch::measure(std::map<place_key, moment>& since,
                         const place_key& key, bool holds, duration& longest) {
  if (!holds) {
    since.erase(key);
    return;
  }
  const auto now = place_.time.scheduler.clock().now();
  const auto begin = since.emplace(key, now).first->second;
  longest =
      std::max(longest, std::chrono::duration_cast<duration>(now - begin));
}

void site_watch::look() {
  for (const auto& node : place_.parties) {
    if (node->coordinates)
      continue;
    std::vector<const site_party*> active;
    for (const auto& c : place_.parties) {
      if (!c->coordinates)
        continue;
      // Who stands still can neither learn nor tell anything.
      const bool shown = is_active(*c, *node) && !place_.is_frozen(*c);
      if (shown)
        active.push_back(c.get());
      measure(lies_, {c->index, node->index}, shown && !believes(*node, *c),
              longest_lie_);
    }
    const bool twice =
        active.size() > 1 && are_connected(place_, *active[0], *active[1]);
    measure(doubles_, {node->index, 0}, twice, longest_double_);
  }
  tasks_.look();
}

void site_watch::live(duration span) {
  for (auto left = span; left > 0ms; left -= period) {
    place_.pass(std::min(left, period));
    look();
  }
}

void print_events(const site& place) {
  for (const auto& x : place.events)
    std::cerr << x.when.count() << " ms " << place.parties[x.party]->name
              << ": " << x.what << " '" << x.subject << "' " << x.data.dump()
              << '\n';
}

} // namespace roscell::test
