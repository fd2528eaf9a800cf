#include "actors/cell/books/drain_book.hpp"

#include "messages/codec/instantiate.hpp"

#include <algorithm>

namespace roscell {

ROSCELL_CODEC(drain_record)

const drained_node* drain_book::find(const std::string& uuid) const {
  const auto i = nodes_.find(uuid);
  return i == nodes_.end() ? nullptr : &i->second;
}

bool drain_book::add(const drain_record& record, time_point now) {
  drained_node x;
  x.record = record;
  x.due = now;
  return nodes_.emplace(record.uuid, x).second;
}

void drain_book::forget(const std::string& uuid) {
  nodes_.erase(uuid);
}

void drain_book::begin(const std::string& uuid) {
  if (const auto i = nodes_.find(uuid); i != nodes_.end())
    i->second.moving = true;
}

void drain_book::end(const std::string& uuid, const std::string& trouble,
                     bool is_empty, time_point now) {
  const auto i = nodes_.find(uuid);
  if (i == nodes_.end())
    return;
  auto& x = i->second;
  x.moving = false;
  x.trouble = trouble;
  x.due = is_empty ? time_point::max() : now + x.pause.next();
}

std::vector<drain_record> drain_book::all() const {
  std::vector<drain_record> result;
  for (const auto& [uuid, x] : nodes_)
    result.push_back(x.record);
  std::stable_sort(result.begin(), result.end(),
                   [](const auto& x, const auto& y) {
                     return x.since_unix_ms < y.since_unix_ms;
                   });
  return result;
}

std::vector<drain_record> drain_book::due(time_point now) const {
  std::vector<drain_record> result;
  for (const auto& [uuid, x] : nodes_)
    if (!x.moving && x.due <= now)
      result.push_back(x.record);
  return result;
}

drain_book::time_point drain_book::next_due() const {
  auto result = time_point::max();
  for (const auto& [uuid, x] : nodes_)
    if (!x.moving)
      result = std::min(result, x.due);
  return result;
}

} // namespace roscell
