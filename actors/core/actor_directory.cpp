#include "actors/core/actor_directory.hpp"

#include <caf/actor_cast.hpp>

#include <algorithm>
#include <utility>

namespace roscell {

void actor_counters::add(uint64_t handling_us) {
  // Only the actor itself writes these two, so there is no lost update.
  ++handled;
  busy_us += handling_us;
  if (handling_us > longest_us)
    longest_us = handling_us;
}

void actor_counters::begin(const caf::actor_addr& self) {
  std::lock_guard guard{mutex_};
  address_ = self;
  id = self.id();
}

caf::actor actor_counters::handle() const {
  std::lock_guard guard{mutex_};
  return caf::actor_cast<caf::actor>(address_);
}

namespace {

/// Whose work this thread does; 0: no actor's.
thread_local uint64_t at_work = 0;

actor_row row_of(const actor_counters& x) {
  actor_row result;
  result.name = x.name;
  result.id = x.id;
  result.parent = x.parent;
  result.messages = x.handled;
  result.mailbox = x.received - std::min<uint64_t>(x.received, result.messages);
  result.busy_us = x.busy_us;
  result.longest_us = x.longest_us;
  return result;
}

} // namespace

working_as::working_as(uint64_t actor_id)
    : before_(std::exchange(at_work, actor_id)) {}

working_as::~working_as() {
  at_work = before_;
}

std::shared_ptr<actor_counters>
actor_directory::enter(const std::string& name) {
  auto result = std::make_shared<actor_counters>();
  result->name = name;
  result->parent = at_work;
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
  for (const auto& known : entries_)
    if (const auto x = known.lock())
      result.push_back(row_of(*x));
  return result;
}

std::vector<actor_directory::entry>
actor_directory::find(const std::string& name_or_id, size_t most) const {
  std::vector<entry> result;
  std::lock_guard guard{mutex_};
  for (const auto& known : entries_) {
    const auto x = known.lock();
    if (result.size() == most || !x)
      continue;
    auto row = row_of(*x);
    if (row.name != name_or_id && std::to_string(row.id) != name_or_id)
      continue;
    if (auto actor = x->handle())
      result.push_back({std::move(row), std::move(actor)});
  }
  return result;
}

} // namespace roscell
