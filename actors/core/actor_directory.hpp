#pragma once

#include "messages/node.hpp"

#include <caf/actor.hpp>
#include <caf/actor_addr.hpp>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace roscell {

/// What one actor has done; written by it, read by anyone.
struct actor_counters {
  std::string name;
  uint64_t parent = 0; ///< Id of the actor that spawned it; 0: none did.
  std::atomic<uint64_t> id{0};
  std::atomic<uint64_t> received{0};
  std::atomic<uint64_t> handled{0};
  std::atomic<uint64_t> busy_us{0};
  std::atomic<uint64_t> longest_us{0};

  /// Counts one handled message.
  void add(uint64_t handling_us);

  /// The actor begins to be one; before that it has no address.
  void begin(const caf::actor_addr& self);

  /// Null when the actor has ended, or has not begun.
  caf::actor handle() const;

private:
  mutable std::mutex mutex_;
  caf::actor_addr address_; // Weak: it keeps no actor alive.
};

/// While it lives, this thread does the work of that actor: what it spawns is
/// the actor's child.
class working_as {
public:
  explicit working_as(uint64_t actor_id);
  ~working_as();

  working_as(const working_as&) = delete;
  working_as& operator=(const working_as&) = delete;

private:
  uint64_t before_;
};

/// Every live actor that the spawn function has spawned on one node.
class actor_directory {
public:
  /// A child of the actor whose work this thread does.
  std::shared_ptr<actor_counters> enter(const std::string& name);

  /// The live actors, oldest first.
  std::vector<actor_row> rows() const;

  /// A live actor and what it has done.
  struct entry {
    actor_row row;
    caf::actor actor;
  };

  /// Those of that name or id, oldest first, `most` at most.
  std::vector<entry> find(const std::string& name_or_id, size_t most) const;

private:
  mutable std::mutex mutex_;
  mutable std::vector<std::weak_ptr<actor_counters>> entries_;
};

} // namespace roscell
