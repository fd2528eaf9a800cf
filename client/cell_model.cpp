#include "client/cell_model.hpp"

#include "messages/codec/json_codec.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// Every instance of the cell once: what its task tells, else what its node
/// does.
std::vector<instance_row> instances_in(const cell_description& cell) {
  std::map<std::string, instance_row> rows;
  for (const auto& task : cell.tasks)
    for (const auto& row : task.instances)
      rows.emplace(row.spec.instance, row);
  for (const auto& node : cell.nodes)
    for (const auto& row : node.instances)
      rows.emplace(row.spec.instance, row);
  std::vector<instance_row> result;
  result.reserve(rows.size());
  for (auto& [id, row] : rows)
    result.push_back(std::move(row));
  return result;
}

/// The node that answers has just measured itself.
void add_own_resources(const node_description& asked, cell_description& cell) {
  for (auto& row : cell.nodes)
    if (row.identity.uuid == asked.identity.uuid)
      row.resources = asked.resources;
}

json particulars_in(const event& e) {
  auto data = json::parse(e.data, nullptr, false);
  return data.is_object() ? data : json::object();
}

/// The text at a name; empty where there is none.
std::string text_in(const json& data, const char* name) {
  const auto found = data.find(name);
  return found != data.end() && found->is_string() ? found->get<std::string>()
                                                   : "";
}

/// Nothing for a word of a newer version.
std::optional<instance_state> state_in(const json& data) {
  const auto word = text_in(data, "state");
  const auto words = enum_words(instance_state{});
  const auto* found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    return std::nullopt;
  return static_cast<instance_state>(found - words.begin());
}

/// What of the answers to ask for again is asked for here.
questions questions_after(const std::string& what) {
  questions result;
  for (const auto& x : stale_after(what)) {
    result.cell = result.cell || x == "cell" || x == "task" || x == "node";
    result.skills = result.skills || x == "skills";
  }
  return result;
}

void put_change(const json& data, const event& e, instance_row& row) {
  const auto state = state_in(data);
  if (!state)
    return;
  if (row.state != *state)
    row.since_unix_ms = e.time_unix_ms;
  row.state = *state;
  row.reason = text_in(data, "reason");
  row.restarts = data.value("restarts", row.restarts);
  row.next_start_unix_ms = data.value("next_start_unix_ms", int64_t{0});
  row.unknown_since_unix_ms = 0;
}

} // namespace

template <class Change>
void cell_model::for_each_row(const Change& change) {
  for (auto& row : known_.instances)
    change(row);
  for (auto& task : known_.cell.tasks)
    for (auto& row : task.instances)
      change(row);
  for (auto& node : known_.cell.nodes)
    for (auto& row : node.instances)
      change(row);
}

void cell_model::open(std::vector<event> kept, int64_t now_unix_ms) {
  connection_ = {true, now_unix_ms, ""};
  auto& events = known_.events;
  std::move(kept.begin(), kept.end(), std::back_inserter(events));
  if (events.size() > most_events)
    events.erase(events.begin(), events.end() - most_events);
}

void cell_model::lose(const std::string& why, int64_t now_unix_ms) {
  if (connection_.live || connection_.since_unix_ms == 0)
    connection_.since_unix_ms = now_unix_ms;
  connection_.live = false;
  connection_.problem = why;
}

void cell_model::miss(const std::string& why) {
  connection_.problem = why;
}

void cell_model::set_cell(node_description asked, cell_description cell) {
  begun_ = true;
  if (connection_.live)
    connection_.problem.clear();
  add_own_resources(asked, cell);
  known_.asked = std::move(asked);
  known_.cell = std::move(cell);
  known_.instances = instances_in(known_.cell);
  std::map<std::string, instance_row> still_there;
  for (const auto& row : known_.instances)
    if (auto node = reported_.extract(row.spec.instance))
      still_there.insert(std::move(node));
  reported_ = std::move(still_there);
  set_metrics({});
}

void cell_model::set_metrics(const std::vector<instance_row>& rows) {
  for (const auto& row : rows)
    reported_[row.spec.instance] = row;
  for_each_row([this](instance_row& row) {
    const auto known = reported_.find(row.spec.instance);
    // Nobody knows what a skill does whose node is away.
    if (known == reported_.end() || row.unknown_since_unix_ms != 0)
      return;
    row.metrics = known->second.metrics;
    row.status = known->second.status;
  });
}

void cell_model::set_skills(skill_list skills) {
  known_.skills = std::move(skills);
}

questions cell_model::add(event e) {
  if (e.what == events::instance_changed)
    change_instance(e);
  else if (e.what == events::node_lost)
    lose_node(e);
  const auto result = questions_after(e.what);
  auto& events = known_.events;
  if (events.size() >= most_events)
    events.erase(events.begin(), events.begin() + most_events / 10);
  events.push_back(std::move(e));
  return result;
}

void cell_model::change_instance(const event& e) {
  const auto data = particulars_in(e);
  // A coordinator's own node tells of its instances without saying where, and
  // the coordinator then says it again for the cell.
  const bool is_reported_again = known_.asked.role == node_role::coordinator
                                 && text_in(data, "node").empty();
  if (is_reported_again)
    return;
  for_each_row([&](instance_row& row) {
    if (row.spec.instance == e.subject)
      put_change(data, e, row);
  });
}

void cell_model::lose_node(const event& e) {
  for (auto& row : known_.cell.nodes)
    if (row.identity.name == e.subject) {
      row.state = row_state::lost;
      row.reason = text_in(particulars_in(e), "reason");
      row.since_unix_ms = e.time_unix_ms;
    }
  for_each_row([&](instance_row& row) {
    if (row.node != e.subject || !is_live(row.state))
      return;
    row.unknown_since_unix_ms = e.time_unix_ms;
    row.metrics = {};
  });
}

namespace {

bool fits(std::string_view what, std::string_view name) {
  if (name.back() != '*')
    return what == name;
  name.remove_suffix(1);
  return what.substr(0, name.size()) == name;
}

} // namespace

const stale_list& stale_answers() {
  static const stale_list result{
      {"node_joined", {"cell", "cells", "skills"}},
      {"node_left", {"cell", "cells", "skills"}},
      {"node_lost", {"cell", "cells", "skills"}},
      {"node_*", {"cell"}},
      {"cell_joined", {"cell", "cells", "skills", "node"}},
      {"cell_left", {"cell", "cells", "node"}},
      {"cell_name_conflict", {"cells"}},
      {"cell_skill_added", {"skills"}},
      {"cell_skill_removed", {"skills"}},
      {"cell*", {"cell", "cells"}},
      {"coordinator_lost", {"cell", "node"}},
      {"transfer_*", {"cell", "cells"}},
      {"switch_*", {"cell"}},
      {"peer_*", {"cells"}},
      {"skill_refused", {"skills"}},
      {"skill_added", {"skills"}},
      {"skill_removed", {"skills"}},
      // Steps that begin, end or go elsewhere.
      {"task_*", {"task"}},
      {"step_*", {"task"}},
      {"allocation_chosen", {"task"}},
      {"instance_changed", {"task"}},
      {"instance_moved", {"task"}},
      {"instance_restarted", {"task"}},
      {"instance_awaited", {"task"}},
      {"instance_out_of_reach", {"task"}},
      {"instance_interrupted", {"task"}},
      {"instance_preempted", {"task"}},
      {"skill_instance_died", {"task"}},
  };
  return result;
}

const std::vector<std::string>& stale_after(std::string_view what) {
  static const std::vector<std::string> none;
  const auto& all = stale_answers();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& x) {
    return fits(what, x.first);
  });
  return found == all.end() ? none : found->second;
}

} // namespace roscell
