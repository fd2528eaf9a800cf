#include "actors/cell/tables/drain_table.hpp"

#include "messages/codec/instantiate.hpp"

#include <algorithm>

namespace roscell {

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

drain_table::time_point drain_table::next_due() const {
  auto result = time_point::max();
  for (const auto& [uuid, x] : nodes_)
    if (!x.moving)
      result = std::min(result, x.due);
  return result;
}

} // namespace roscell
