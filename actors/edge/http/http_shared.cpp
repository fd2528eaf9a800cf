#include "actors/edge/http/http_shared.hpp"

#include "actors/edge/http/http_connection.hpp"

#include <utility>

namespace roscell {

connection_table::connection_table(const http_limits& limits)
    : limits_{limits.strangers, limits.trusted, limits.local} {
  // nop
}

bool connection_table::full(http_group group) {
  return count(group) >= limits_[static_cast<size_t>(group)];
}

bool connection_table::make_room(http_group group) {
  if (group == http_group::strangers && full(group))
    evict_stranger();
  return !full(group);
}

void connection_table::add(std::shared_ptr<http_connection> connection,
                           http_group group) {
  const auto* key = connection.get();
  entries_.emplace(key, entry{std::move(connection), group});
  ++count(group);
}

bool connection_table::trust(const http_connection* connection) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return false;
  auto& group = i->second.group;
  if (group != http_group::strangers)
    return true;
  if (full(http_group::trusted))
    return false;
  --count(group);
  group = http_group::trusted;
  ++count(group);
  return true;
}

void connection_table::remove(const http_connection* connection) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return;
  --count(i->second.group);
  entries_.erase(i);
}

void connection_table::evict_stranger() {
  std::shared_ptr<http_connection> silent;
  for (const auto& [key, entry] : entries_)
    if (entry.group == http_group::strangers
        && (!silent || key->last_heard() < silent->last_heard()))
      silent = entry.connection;
  if (silent)
    silent->abort();
}

std::vector<std::shared_ptr<http_connection>> connection_table::all() const {
  std::vector<std::shared_ptr<http_connection>> result;
  result.reserve(entries_.size());
  for (const auto& [key, entry] : entries_)
    result.push_back(entry.connection);
  return result;
}

} // namespace roscell
