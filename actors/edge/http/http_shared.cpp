#include "actors/edge/http/http_shared.hpp"

#include "actors/edge/http/http_connection.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

edge_error crowd_error() {
  return {error_code::conflict, "too many clients are connected",
          "ask again in a moment; clients that follow events or logs keep "
          "their places until they end"};
}

connection_table::connection_table(const http_limits& limits)
    : limits_{limits.unauthenticated_peers, limits.joining, limits.trusted,
              limits.local, limits.refused},
      waiting_limit_(limits.waiting) {
  // nop
}

bool connection_table::full(http_group group) {
  return count(group) >= limits_[static_cast<size_t>(group)];
}

bool connection_table::make_room(http_group group) {
  const bool unproven = group == http_group::unauthenticated_peers
                        || group == http_group::joining;
  if (unproven && full(group))
    evict_from(group);
  return !full(group)
         || (group == http_group::local && queue_.size() < waiting_limit_);
}

void connection_table::add(const std::shared_ptr<http_connection>& connection,
                           http_group group) {
  const bool queued = full(group);
  entries_.emplace(connection.get(), entry{connection, group, queued});
  if (queued) {
    queue_.push_back(connection.get());
    return connection->wait_for_turn();
  }
  ++count(group);
  connection->run();
}

bool connection_table::refuse(
    const std::shared_ptr<http_connection>& connection) {
  if (full(http_group::refused))
    return false;
  entries_.emplace(connection.get(),
                   entry{connection, http_group::refused, false});
  ++count(http_group::refused);
  connection->refuse_crowd();
  return true;
}

void connection_table::serve_next() {
  while (!queue_.empty() && !full(http_group::local)) {
    auto& next = entries_.at(queue_.front());
    queue_.pop_front();
    next.queued = false;
    ++count(http_group::local);
    // A copy, since its end would drop the entry.
    const auto connection = next.connection;
    connection->run();
  }
}

bool connection_table::promote(const http_connection* connection,
                               http_group group) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return false;
  if (i->second.group != http_group::unauthenticated_peers)
    return true;
  if (!make_room(group))
    return false;
  --count(i->second.group);
  i->second.group = group;
  ++count(group);
  return true;
}

void connection_table::remove(const http_connection* connection) {
  const auto i = entries_.find(connection);
  if (i == entries_.end())
    return;
  const auto gone = i->second;
  entries_.erase(i);
  if (gone.queued) {
    queue_.erase(std::find(queue_.begin(), queue_.end(), connection));
    return;
  }
  --count(gone.group);
  serve_next();
}

void connection_table::evict_from(http_group group) {
  std::shared_ptr<http_connection> silent;
  for (const auto& [key, entry] : entries_)
    if (entry.group == group
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
