#include "actors/house/actor_directory.hpp"

#include <algorithm>

namespace roscell {

void actor_counters::add(uint64_t handling_us) {
  // Only the actor itself writes these two, so there is no lost update.
  ++handled;
  busy_us += handling_us;
  if (handling_us > longest_us)
    longest_us = handling_us;
}

std::shared_ptr<actor_counters>
actor_directory::enter(const std::string& name) {
  auto result = std::make_shared<actor_counters>();
  result->name = name;
  std::lock_guard guard{mutex_};
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(),
                                [](const auto& x) { return x.expired(); }),
                 entries_.end());
  entries_.push_back(result);
  return result;
}

std::vector<actor_row> actor_directory::rows() const {
  std::vector<actor_row> result;
  std::lock_guard guard{mutex_};
  for (const auto& entry : entries_) {
    auto x = entry.lock();
    if (!x)
      continue;
    actor_row row;
    row.name = x->name;
    row.id = x->id;
    row.messages = x->handled;
    row.mailbox = x->received - std::min<uint64_t>(x->received, row.messages);
    row.busy_us = x->busy_us;
    row.longest_us = x->longest_us;
    result.push_back(std::move(row));
  }
  return result;
}

} // namespace roscell
