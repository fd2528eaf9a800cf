#include "actors/cell/tables/transfer_table.hpp"

#include "actors/cell/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace roscell {

namespace {

void enter(transfer_row& row, transfer_state state, const std::string& reason,
           int64_t unix_ms) {
  row.state = state;
  row.reason = reason;
  row.since_unix_ms = unix_ms;
}

} // namespace

bool is_open(transfer_state x) {
  return x == transfer_state::preparing || x == transfer_state::switching
         || x == transfer_state::unresolved;
}

store_record record_of(const transfer_row& row) {
  return {"transfers", row.transfer, json(row).dump()};
}

transfer_table::transfer_table(std::string cell, int64_t incarnation)
    : prefix_(cell + "-" + std::to_string(incarnation) + "-"),
      cell_(std::move(cell)) {}

std::string transfer_table::new_id() {
  return prefix_ + std::to_string(++last_);
}

void transfer_table::restore(const transfer_row& row) {
  auto& x = transfers_[row.transfer];
  x.row = row;
  x.kept = true;
}

const transfer_row& transfer_table::propose(const std::string& node,
                                            const std::string& uuid,
                                            const std::string& to,
                                            int64_t unix_ms) {
  auto id = new_id();
  auto& x = transfers_[id];
  x.row.transfer = std::move(id);
  x.row.node = node;
  x.row.uuid = uuid;
  x.row.from = cell_;
  x.row.to = to;
  x.row.since_unix_ms = unix_ms;
  return x.row;
}

void transfer_table::open(const std::string& id) {
  if (auto* x = find_proposed(id))
    x->kept = true;
}

std::vector<transfer_done> transfer_table::withdraw(const std::string& id) {
  auto* x = find_proposed(id);
  if (!x)
    return {};
  auto waiting = std::move(x->waiting);
  transfers_.erase(id);
  return waiting;
}

std::string transfer_table::holder_of(const std::string& uuid) const {
  for (const auto& [id, x] : transfers_)
    if (x.row.uuid == uuid && is_open(x.row.state))
      return id;
  return {};
}

bool transfer_table::is_busy(const std::string& uuid) const {
  return std::any_of(transfers_.begin(), transfers_.end(), [&](const auto& x) {
    const auto& row = x.second.row;
    return row.uuid == uuid && is_open(row.state)
           && row.state != transfer_state::unresolved;
  });
}

cell_transfer* transfer_table::find_proposed(const std::string& id) {
  const auto i = transfers_.find(id);
  return i == transfers_.end() || i->second.kept ? nullptr : &i->second;
}

cell_transfer* transfer_table::find_open(const std::string& id) {
  const auto i = transfers_.find(id);
  const bool open =
      i != transfers_.end() && i->second.kept && is_open(i->second.row.state);
  return open ? &i->second : nullptr;
}

cell_transfer* transfer_table::find_open_of(const std::string& uuid) {
  for (auto& [id, x] : transfers_)
    if (x.row.uuid == uuid && x.kept && is_open(x.row.state))
      return &x;
  return nullptr;
}

transfer_row transfer_table::switching_row(const cell_transfer& x,
                                           int64_t unix_ms) const {
  auto result = x.row;
  enter(result, transfer_state::switching, "", unix_ms);
  return result;
}

void transfer_table::begin_switch(cell_transfer& x, const transfer_row& row,
                                  time_point now) {
  x.row = row;
  x.deadline = now + limits::transfer::arrival;
}

std::vector<std::string> transfer_table::overdue(time_point now) const {
  std::vector<std::string> result;
  for (const auto& [id, x] : transfers_)
    if (x.deadline <= now)
      result.push_back(id);
  return result;
}

transfer_table::time_point transfer_table::next_deadline() const {
  auto result = time_point::max();
  for (const auto& [id, x] : transfers_)
    result = std::min(result, x.deadline);
  return result;
}

std::vector<transfer_done>
transfer_table::set_unresolved(cell_transfer& x, const std::string& reason,
                               int64_t unix_ms) {
  enter(x.row, transfer_state::unresolved, reason, unix_ms);
  x.deadline = time_point::max();
  return std::exchange(x.waiting, {});
}

std::optional<cell_transfer> transfer_table::end(const std::string& id,
                                                 transfer_state state,
                                                 const std::string& reason,
                                                 int64_t unix_ms) {
  auto* x = find_open(id);
  if (!x)
    return std::nullopt;
  enter(x->row, state, reason, unix_ms);
  x->deadline = time_point::max();
  auto result = *x;
  x->waiting.clear();
  return result;
}

std::vector<std::string> transfer_table::forget_oldest() {
  std::vector<std::tuple<int64_t, std::string>> ended;
  for (const auto& [id, x] : transfers_)
    if (!is_open(x.row.state))
      ended.emplace_back(x.row.since_unix_ms, id);
  std::vector<std::string> result;
  if (ended.size() <= limits::transfer::ended)
    return result;
  std::sort(ended.begin(), ended.end());
  ended.resize(ended.size() - limits::transfer::ended);
  for (const auto& [since, id] : ended) {
    transfers_.erase(id);
    result.push_back(id);
  }
  return result;
}

const transfer_row* transfer_table::find_gone(const std::string& node) const {
  const transfer_row* result = nullptr;
  for (const auto& [id, x] : transfers_)
    if (x.row.node == node && x.row.state == transfer_state::done
        && (!result || result->since_unix_ms <= x.row.since_unix_ms))
      result = &x.row;
  return result;
}

std::vector<transfer_row> transfer_table::rows(const std::string& id) const {
  std::vector<transfer_row> result;
  for (const auto& [key, x] : transfers_)
    if (x.kept && (id.empty() || id == key))
      result.push_back(x.row);
  std::sort(result.begin(), result.end(), [](const auto& x, const auto& y) {
    return x.since_unix_ms < y.since_unix_ms;
  });
  return result;
}

ROSCELL_CODEC(drain_record)

const drained_node* drain_table::find(const std::string& uuid) const {
  const auto i = nodes_.find(uuid);
  return i == nodes_.end() ? nullptr : &i->second;
}

bool drain_table::add(const drain_record& record, time_point now) {
  drained_node x;
  x.record = record;
  x.due = now;
  return nodes_.emplace(record.uuid, x).second;
}

void drain_table::forget(const std::string& uuid) {
  nodes_.erase(uuid);
}

void drain_table::begin(const std::string& uuid) {
  if (const auto i = nodes_.find(uuid); i != nodes_.end())
    i->second.moving = true;
}

void drain_table::end(const std::string& uuid, const std::string& problem,
                      bool is_empty, time_point now) {
  const auto i = nodes_.find(uuid);
  if (i == nodes_.end())
    return;
  auto& x = i->second;
  x.moving = false;
  x.problem = problem;
  x.due = is_empty ? time_point::max() : now + x.pause.next();
}

std::vector<drain_record> drain_table::all() const {
  std::vector<drain_record> result;
  for (const auto& [uuid, x] : nodes_)
    result.push_back(x.record);
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& x, const auto& y) {
                     return x.since_unix_ms < y.since_unix_ms;
                   });
  return result;
}

std::vector<drain_record> drain_table::due(time_point now) const {
  std::vector<drain_record> result;
  for (const auto& [uuid, x] : nodes_)
    if (!x.moving && x.due <= now)
      result.push_back(x.record);
  return result;
}

void drain_table::hurry(time_point now) {
  for (auto& [uuid, x] : nodes_)
    if (!x.problem.empty())
      x.due = std::min(x.due, now);
}

drain_table::time_point drain_table::next_due() const {
  auto result = time_point::max();
  for (const auto& [uuid, x] : nodes_)
    if (!x.moving)
      result = std::min(result, x.due);
  return result;
}

} // namespace roscell
